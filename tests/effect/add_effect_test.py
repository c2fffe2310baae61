# SPDX-License-Identifier: Apache-2.0
"""Adds the effect of docs/howto_add_effect.md: add_effect_test.py BUILD_DIRECTORY CMAKE.

A copy of golden/physics gets the one file and is configured on its own: the build must take the file by itself. It alone is
compiled, and linked with the objects of the build to a program of its own, which must list, explain and simulate the effect.
"""
import csv
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
build, cmake = pathlib.Path(sys.argv[1]), sys.argv[2]
example = ROOT / "docs/examples/supply_rate.cpp"

PROJECT = f"""cmake_minimum_required(VERSION 3.25)
project(scratch LANGUAGES CXX)
set(CMAKE_CXX_STANDARD 20)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(Boost REQUIRED)
add_library(hemi_options INTERFACE)
target_include_directories(hemi_options INTERFACE ${{CMAKE_SOURCE_DIR}} {ROOT})
target_compile_options(hemi_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Werror)
add_subdirectory(golden/physics)
"""

SCENARIO = """[scenario]
name = "supply"
duration = "200 s"
noise = false
[supply]
steps = [["0 s", 5], ["100 s", 5.4]]
[[effect]]
id = "supply_rate"
per_v = 2.5
"""


def run(*words, **more):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **more)
    assert done.returncode == 0, f"{words}\n{done.stdout}{done.stderr}"
    return done.stdout


def link_with(extra, program):
    """The build's own command for hemi, with one more object and another output."""
    command = run("ninja", "-C", build, "-t", "commands", "-s", "hemi").splitlines()[-1]
    assert command.count(" -o hemi ") == 1, command
    command = command.replace(" -o hemi ", f" -o {shlex.quote(str(program))} {shlex.quote(str(extra))} ")
    run("sh", "-c", command, cwd=build)


page = (ROOT / "docs/howto_add_effect.md").read_text()
quoted = re.search(r"```cpp\n(.*?)```", page, re.DOTALL)[1]
assert quoted == example.read_text(), f"the page and {example} differ"

with tempfile.TemporaryDirectory() as directory:
    scratch = pathlib.Path(directory)
    shutil.copytree(ROOT / "golden/physics", scratch / "golden/physics")
    shutil.copy(example, scratch / "golden/physics/effects")
    (scratch / "CMakeLists.txt").write_text(PROJECT)
    run(cmake, "-S", scratch, "-B", scratch / "made", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release")
    target = "golden/physics/CMakeFiles/hemi_physics_effects.dir/effects/supply_rate.cpp.o"
    run("ninja", "-C", scratch / "made", target)
    hemi = scratch / "hemi"
    link_with(scratch / "made" / target, hemi)

    listed = [line.split()[0] for line in run(hemi, "effects").splitlines() if line]
    before = [line.split()[0] for line in run(build / "hemi", "effects").splitlines() if line]
    assert "supply_rate" in listed and "supply_rate" not in before
    assert "R += per_v (supply - 5 V)" in run(hemi, "effects", "supply_rate")
    (scratch / "supply.toml").write_text(SCENARIO)
    run(hemi, "simulate", "supply.toml", cwd=scratch)
    with open(scratch / "supply.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    rate = {int(float(row["time_s"])): float(row["rate_dph"]) for row in rows}
    # Settled on both sides: 0.4 V more at 2.5 deg/h/V; the twin's other parts do not know of the supply. The loop's slow mode,
    # a tenth of 40 Hz, has ended; what is left is the CSV's last digit.
    step = rate[150] - rate[90]
    assert abs(step - 1.0) < 1e-6, step
    print(f"{len(listed) - len(before)} effect more; 0.4 V of supply move the rate by {step:.9f} deg/h")

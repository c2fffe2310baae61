# SPDX-License-Identifier: Apache-2.0
"""The FuseSoC core file: core_file_test.py BUILD_DIRECTORY CMAKE VERILATOR VERSION.

In a scratch prefix every listed file must exist, every .sv file must be listed, and Verilator must take the files of each
target in the order that FuseSoC hands them over. FuseSoC itself is not needed, and not among Debian's packages.
"""
import pathlib
import subprocess
import sys
import tempfile

import yaml

build, cmake, verilator, version = sys.argv[1:]
PLL = pathlib.Path(__file__).resolve().parents[2] / "tb/board/SB_PLL40_PAD.sv"  # the vendor's cell of the board's top


def names(fileset):
    return [next(iter(file)) if isinstance(file, dict) else file for file in fileset["files"]]


with tempfile.TemporaryDirectory() as prefix:
    subprocess.run([cmake, "--install", build, "--prefix", prefix], check=True, capture_output=True)
    root = pathlib.Path(prefix, "share/hemi/rtl")
    first, text = (root / "hemi.core").read_text().split("\n", 1)
    assert first == "CAPI=2:", first
    core = yaml.safe_load(text)
    assert core["name"] == f"::hemi:{version}", f"{core['name']} in a build of version {version}"
    filesets = core["filesets"]
    listed = {name for fileset in filesets.values() for name in names(fileset)}
    missing = sorted(name for name in listed if not (root / name).is_file())
    assert not missing, f"listed, but not installed: {missing}"
    unlisted = sorted({str(file.relative_to(root)) for file in root.rglob("*.sv")} - listed)
    assert not unlisted, f"installed, but not listed: {unlisted}"
    for target, description in core["targets"].items():
        files = [name for fileset in description["filesets"] for name in names(filesets[fileset])]
        sources = [str(root / name) for name in files if name.endswith(".sv")]
        if "hemi_board_up5k" in description["toplevel"]:
            sources.append(str(PLL))
        options = description.get("tools", {}).get("verilator", {}).get("verilator_options", [])
        run = subprocess.run([verilator, "--lint-only", "-Wno-MULTITOP", *options, "--top-module",
                              description["toplevel"], *sources], capture_output=True, text=True, check=False)
        assert run.returncode == 0, f"target {target}:\n{run.stderr}"
        print(f"target {target}: {len(sources)} files, top {description['toplevel']}")

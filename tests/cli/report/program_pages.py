#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""program_pages.py HEMI TABLE DIRECTORY: a page of each command, made by the program itself, for browser_test.mjs."""
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys

hemi, table, directory = sys.argv[1], os.path.abspath(sys.argv[2]), pathlib.Path(sys.argv[3])
shutil.rmtree(directory, ignore_errors=True)
work = directory / "work"
work.mkdir(parents=True)


def run(*arguments):
    """0: nothing found; 1: something was found. Both write a page."""
    done = subprocess.run([hemi, *arguments], cwd=work, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"hemi {' '.join(arguments)}: exit code {done.returncode}\n{done.stdout}{done.stderr}")


def take(page, name):
    shutil.move(work / page, directory / f"{name}.html")


def write_tone():
    """Two seconds of a pickoff with a third harmonic, as a converter's curve makes it."""
    random.seed(5)
    with open(work / "tone.raw.csv", "w", encoding="ascii") as out:
        out.write("adc_x,adc_y\n")
        for i in range(200000):
            phase = 2.0 * math.pi * 4432.1 * i / 1e5
            x = 26000.0 * math.sin(phase) + 20.0 * math.sin(3.0 * phase) + random.gauss(0.0, 0.6)
            y = 260.0 * math.sin(phase) + random.gauss(0.0, 0.6)
            out.write(f"{round(x)},{round(y)}\n")
    sidecar = {"raw": {"sample_rate_hz": 100000, "full_scale_lsb": 32768}}
    (work / "tone.json").write_text(json.dumps(sidecar), encoding="ascii")


def write_bench():
    """A driven resonator with a cubic spring: 8192 rows at 610 Hz, semi-implicit Euler at 16 times that."""
    random.seed(6)
    rate, steps = 610.0, 16
    h = 1.0 / (rate * steps)
    level, y, v = 0.0, 0.0, 0.0
    with open(work / "bench.csv", "w", encoding="ascii") as out:
        out.write("time_s,force_v,displacement_v\n")
        for i in range(8192):
            if i % 8 == 0:
                level = random.gauss(0.0, 0.05)
            out.write(f"{i / rate!r},{level!r},{y + random.gauss(0.0, 2e-5)!r}\n")
            for _ in range(steps):
                v += h * (1.9e5 * level - 50.0 * v - 2.0e5 * y - 6.0e5 * y**3)
                y += h * v


def write_case():
    """A cheap gyro in a chamber: its rate follows the case behind a lag."""
    random.seed(7)
    lagged = 20.0
    with open(work / "case.csv", "w", encoding="ascii") as out:
        out.write("time_s,case_temp_degc,rate_dph\n")
        for i in range(4000):
            degc = 20.0 + 25.0 * math.sin(2.0 * math.pi * i / 1600.0) + 3.0 * math.sin(2.0 * math.pi * i / 370.0)
            lagged += (degc - lagged) / 120.0
            rate = 40.0 * degc + 0.3 * degc**2 + 90.0 * lagged + random.gauss(0.0, 60.0)
            out.write(f"{i},{degc:.4f},{rate:.3f}\n")


shutil.copy(table, work / "paper_table1.csv")
table = "paper_table1.csv"
write_tone()
write_bench()
write_case()
run("calibrate", table, "--order", "3", "-o", "hrg.model.json", "--report", "pages")
take("pages/calibration.html", "calibration")
run("run", "tone.raw.csv", "-f", "4432", "-o", "out.csv", "--report", "pages")
take("pages/run.html", "run")
run("compare", "tone.raw.csv", "-f", "4432", "-e", "golden,hls,ideal", "--report", "pages")
take("pages/compare.html", "compare")
run("allan", "case.csv", "--report", "pages")
take("pages/allan.html", "allan")
for name, recording in (("diagnosis-table", table), ("diagnosis-capture", "tone.raw.csv"), ("diagnosis-bench", "bench.csv"),
                        ("diagnosis-case", "case.csv")):
    run("diagnose", recording, "-o", "out")
    take("out/report.html", name)
run("simulate", "hysteresis", "-o", "chamber")
run("diagnose", "chamber/hysteresis.csv", "--model", "chamber/hysteresis.model.json", "-o", "out")
take("out/report.html", "diagnosis")
run("report", "chamber/hysteresis.csv", "-o", "recording.html")
take("recording.html", "recording")
run("prove", "--cases", "2", "--class", "null", "-j", "1", "-o", "proof")
take("proof/prove.html", "prove")
shutil.rmtree(work)

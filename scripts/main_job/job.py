# SPDX-License-Identifier: Apache-2.0
"""What every step of the main job needs: the program, the engines side by side, the report, plots."""

import csv
import filecmp
import json
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEMI = ROOT / "build" / "hemi"
EXAMPLES = ROOT / "build" / "hemi_examples"
RESULTS = ROOT / "results"
PLOTS = pathlib.Path(__file__).resolve().parent / "plots"
RECORDINGS = pathlib.Path(os.environ.get("HEMI_SHARED", ROOT.parent / "shared")) / "recordings" / "real"

# Bit for bit equal; `ideal` has no rounding and comes along where the difference is of interest.
ENGINES = ["golden", "hls", "rtl", "systemc"]


class JobError(Exception):
    """A step that failed, in one line."""


def short(path):
    """A path as the reader sees it from the root of the tree."""
    path = pathlib.Path(path)
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(path)


def command_line(command):
    return " ".join(short(word) if str(word).startswith("/") else str(word) for word in command)


def run(*command):
    """Standard output of a command; JobError where it fails."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or ["no message"]
        raise JobError(f"exit {done.returncode} of: {command_line(command)}\n  {lines[-1]}")
    return done.stdout


def hemi(*arguments):
    return run(HEMI, *arguments)


def hemi_json(*arguments):
    return json.loads(hemi(*arguments, "--json"))


def all_engines(recording, name, *arguments, ideal=False):
    """The recording through every engine into results/NAME.ENGINE.csv, at the same time; the fixed-point ones must
    write the same bytes. Returns each engine's summary."""
    engines = ENGINES + (["ideal"] if ideal else [])
    running = {}
    for engine in engines:
        command = [HEMI, "run", recording, "--engine", engine, *arguments, "-o", output(name, engine), "--json"]
        command = [str(word) for word in command]
        running[engine] = command, subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    summaries, failures = {}, []
    for engine, (command, process) in running.items():
        text, errors = process.communicate()
        if process.returncode == 0:
            summaries[engine] = json.loads(text)
        else:
            lines = errors.strip().splitlines() or ["no message"]
            failures.append(f"exit {process.returncode} of: {command_line(command)}\n  {lines[-1]}")
    if failures:
        raise JobError("\n".join(failures))
    for engine in ENGINES[1:]:
        if not filecmp.cmp(output(name, ENGINES[0]), output(name, engine), shallow=False):
            raise JobError(f"engines disagree: {short(output(name, ENGINES[0]))} and {short(output(name, engine))} differ"
                           f"\n  to see where: build/hemi compare {short(recording)} --engines {ENGINES[0]},{engine} "
                           + command_line(comparable(arguments)))
    return summaries


def comparable(arguments):
    """Those of a run's options that `hemi compare` knows."""
    pairs = zip(arguments[::2], arguments[1::2])
    return [word for pair in pairs if pair[0] in ("--model", "--frequency") for word in pair]


def output(name, engine):
    return RESULTS / f"{name}.{engine}.csv"


def columns(path, *names):
    """Columns of a CSV file as lists of numbers; an empty cell is nan."""
    with open(path, newline="") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        table = [[float(row[name] or "nan") for name in names] for row in rows]
    return [list(column) for column in zip(*table)]


def write_columns(path, **named):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(named)
        writer.writerows(zip(*named.values()))


def averages(values, count):
    """Means of `count` values in a row; what is left over at the end is dropped."""
    return [sum(values[i:i + count]) / count for i in range(0, len(values) - count + 1, count)]


def plot(name, **variables):
    """results/NAME.svg from plots/NAME.gp; the variables are text in the script."""
    settings = "".join(f"{key} = '{value}';" for key, value in variables.items())
    run("gnuplot", "-e", f"results = '{RESULTS}'; output = '{RESULTS / name}.svg'; {settings}", PLOTS / "style.gp",
        PLOTS / f"{name}.gp")


class Report:
    """Sections in Markdown: on the terminal at once, in results/summary.md at the end."""

    def __init__(self):
        self.parts = []

    def add(self, text):
        print(text + "\n", flush=True)
        self.parts.append(text)

    def section(self, title):
        self.add("## " + title)

    def table(self, header, rows):
        rows = [header, *rows]
        widths = [max(len(str(row[i])) for row in rows) for i in range(len(header))]
        lines = ["| " + " | ".join(str(cell).ljust(width) for cell, width in zip(row, widths)) + " |" for row in rows]
        lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
        self.add("\n".join(lines))

    def figure(self, name, caption):
        self.parts.append(f"![{caption}]({name}.svg)")

    def write(self):
        (RESULTS / "summary.md").write_text("# Main job\n\n" + "\n\n".join(self.parts) + "\n")

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutates one line at a time and demands that the bench sees it, in the right block, at the first sample that differs.

mutations file: blocks of four lines "FILE", "OLD", "NEW", "BLOCK", separated by blank lines; '#' starts a comment. OLD must stand
in FILE exactly once. builder: command that gets the folder with the mutated copy of the sources and the path of the program to
build. Prints a line a mutant and exits 1 when one survives or is located wrongly.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor


def read_mutations(path):
    lines = [line.rstrip("\n") for line in open(path) if not line.startswith("#")]
    groups = [group.split("\n") for group in "\n".join(lines).strip("\n").split("\n\n")]
    for group in groups:
        if len(group) != 4:
            sys.exit(f"{path}: a mutation has four lines, this has {len(group)}: {group}")
    return groups


def judge(source, builder, mutation, work):
    """(passed, text) of one mutation; None stands for the sources as they are."""
    tree = pathlib.Path(work) / "tree"
    shutil.copytree(source, tree / source.name)
    expected = "none"
    if mutation:
        name, old, new, expected = mutation
        target = tree / name
        text = target.read_text()
        if text.count(old.strip()) != 1:
            return False, f"{name}: '{old.strip()}' stands there {text.count(old.strip())} times, not once"
        target.write_text(text.replace(old.strip(), new.strip()))
    program = pathlib.Path(work) / "mutant"
    built = subprocess.run([*builder, str(tree), str(program)], capture_output=True, text=True)
    if built.returncode != 0:
        return False, "does not build: " + (built.stderr + built.stdout)[-1500:]
    run = subprocess.run([str(program)], capture_output=True, text=True, timeout=300)
    lines = run.stdout.splitlines() + ["", ""]
    located, by_traces = lines[0], lines[1]
    label = f"{mutation[0]}: {mutation[1].strip()} -> {mutation[2].strip()}" if mutation else "as it is"
    if run.returncode not in (0, 1):
        return False, f"{label}: ended with {run.returncode}: {run.stderr[-500:]}"
    good = located.split(" ")[0] == expected and located == by_traces and (expected != "none" or lines[2] == "records equal")
    return good, f"{label}\n    located: {located}; by complete traces: {by_traces}; expected block: {expected}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=pathlib.Path, required=True, help="folder to copy and mutate (hls or rtl)")
    parser.add_argument("--mutations", required=True)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("builder", nargs="+")
    arguments = parser.parse_args()
    mutations = [None] + read_mutations(arguments.mutations)

    def one(mutation):
        with tempfile.TemporaryDirectory() as work:
            return judge(arguments.source.resolve(), arguments.builder, mutation, work)

    with ThreadPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(one, mutations))
    for passed, text in results:
        print("ok  " if passed else "FAIL", text)
    caught = sum(passed for passed, _ in results[1:])
    print(f"{caught} of {len(mutations) - 1} mutants caught and located")
    sys.exit(0 if all(passed for passed, _ in results) else 1)


if __name__ == "__main__":
    main()

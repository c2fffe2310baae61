#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutates one line of rtl/axi (or rtl/board) at a time, links the test to the model made of it and demands that it fails.

Without a mutation the test must pass. Prints a line a mutant and exits 1 when one survives.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile


def build_and_run(options, modules, work):
    """(exit code of the test, its words); the test itself is compiled already."""
    model = work / "model"
    package = modules / options.package
    rest = sorted(f for f in modules.glob("*.sv") if f != package)
    subprocess.run([options.verilator, "--cc", "--build", "-O3", "--x-assign", "fast", "--x-initial", "fast", "--noassert",
                    "-Wno-fatal", "-Wno-lint", "--prefix", options.prefix, "--top-module", options.top, "-Mdir", model,
                    f"-I{options.include}", "-MAKEFLAGS", "OPT_FAST=-O1", *options.sources.split(","), package, *rest],
                   check=True, capture_output=True)
    program = work / "test"
    subprocess.run([options.compiler, *options.objects.split(","), "-Wl,--start-group", model / f"{options.prefix}__ALL.a",
                    *options.libraries.split(","), "-Wl,--end-group", "-lgtest_main", "-lgtest", "-lfmt", "-lz", "-lpthread", "-o", program], check=True, capture_output=True)
    try:
        run = subprocess.run([program], capture_output=True, text=True, timeout=120)
        return run.returncode, run.stdout + run.stderr
    except subprocess.TimeoutExpired:
        return -1, "takes for ever"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("compiler", "verilator", "modules", "mutations", "include", "sources", "objects", "libraries"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--prefix", default="Vhemi_axi")
    parser.add_argument("--top", default="hemi_axi")
    parser.add_argument("--package", default="hemi_axi_pkg.sv")
    options = parser.parse_args()
    text = "\n".join(line for line in open(options.mutations).read().split("\n") if not line.startswith("#"))
    mutations = [None] + [group.split("\n") for group in text.strip("\n").split("\n\n")]
    survivors = 0
    for mutation in mutations:
        with tempfile.TemporaryDirectory() as directory:
            work = pathlib.Path(directory)
            modules = work / "modules"
            shutil.copytree(options.modules, modules)
            label = "as it is"
            if mutation:
                name, old, new = mutation
                target = modules / name
                source = target.read_text()
                if source.count(old) != 1:
                    sys.exit(f"{name}: '{old}' stands there {source.count(old)} times, not once")
                target.write_text(source.replace(old, new))
                label = f"{name}: {old.strip()} -> {new.strip()}"
            code, words = build_and_run(options, modules, work)
            good = (code != 0) == bool(mutation)
            survivors += not good
            told = [line.strip() for line in words.split("\n") if "description" in line or "Failure" in line]
            print(f"{'ok  ' if good else 'BAD '} {label}\n       exit {code} {told[:1]}", flush=True)
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())

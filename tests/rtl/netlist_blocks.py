#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Netlists of single blocks beside the blocks themselves, on the regression's vectors.

Each module that BLOCKS lists is synthesized alone for the iCE40 UP5K. In the design under test its place is taken by a
module of the same name that has the block, which drives the outputs, and the netlist, cell by cell, which gets the same
inputs; at each clock (a block without one takes the design's) all outputs of the two are compared. The design's own test
runs on that and must pass. Then once more with one cell of each netlist changed, a look-up table inverted or a
memory's first line: each must be found to differ.
"""
import argparse
import collections
import json
import pathlib
import re
import shutil
import subprocess
import sys

CLOCKS = ("clk_i", "aclk")
LINE = re.compile(r"netlist of (\w+): (\d+) compared, (\d+) differ")


def run(command, log):
    with open(log, "w") as out:
        if subprocess.run([str(c) for c in command], stdout=out, stderr=subprocess.STDOUT).returncode:
            sys.exit(f"netlist_blocks: {command[0]} failed:\n{pathlib.Path(log).read_text()[-2000:]}")


def synthesize(options, module):
    """Netlist of a module alone, renamed MODULE_netlist: its text and its ports."""
    stem = options.work / module
    run([options.yosys, "-q", "-p",
         f"read_verilog -sv -I{options.include} {' '.join(options.sources)}; synth_ice40 -device u -dsp -top {module}; "
         f"check -assert; rename -top {module}_netlist; write_verilog -noattr {stem}.v; write_json {stem}.json"],
        f"{stem}.log")
    ports = json.load(open(f"{stem}.json"))["modules"][f"{module}_netlist"]["ports"]
    return pathlib.Path(f"{stem}.v").read_text(), ports


def pair(options, module, ports, parameters):
    """Text of the module that has both. Of parameters, those that the netlist was made with are the only ones."""
    declared, connections, outputs = [], {"block": [], "netlist": []}, []
    for name, port in ports.items():
        width = f"[{len(port['bits']) - 1}:0]"
        declared.append(f"{port['direction']} logic {width} {name}")
        for which in connections:
            inner = f"{which}_{name}" if port["direction"] == "output" else name
            connections[which].append(f".{name}({inner})")
        if port["direction"] == "output":
            outputs.append((name, width))
    clock = next((name for name in CLOCKS if name in ports), options.clock)
    wires = "".join(f"  logic {width} block_{name}, netlist_{name};\n  assign {name} = block_{name};\n"
                    for name, width in outputs)
    unequal = " || ".join(f"block_{name} != netlist_{name}" for name, _ in outputs)
    passed = ", ".join(f".{name}({name})" for name in parameters)
    head = f" #(parameter {', '.join(f'int {n} = {v}' for n, v in parameters.items())})" if parameters else ""
    return (f"module {module}{head} ({', '.join(declared)});\n{wires}"
            f"  {module}_block {f'#({passed})' if parameters else ''} i_block ({', '.join(connections['block'])});\n"
            f"  {module}_netlist i_netlist ({', '.join(connections['netlist'])});\n"
            f"  longint compared = 0, differ = 0;\n"
            f"  always @(posedge {clock}) begin\n"
            f"    compared = compared + 1;\n    if ({unequal}) differ = differ + 1;\n  end\n"
            f'  final $display("netlist of {module}: %0d compared, %0d differ", compared, differ);\nendmodule\n')


def mutant(text):
    """The netlist with its middle look-up table inverted; where it has none, with the first line of its first memory."""
    found = list(re.finditer(r"\.LUT_INIT\(16'h([0-9a-f]+)\)", text))
    places = found or list(re.finditer(r"\.INIT_0\(256'h([0-9a-f]+)\)", text))[:1]
    if not places:
        sys.exit("netlist_blocks: no look-up table and no filled memory to change")
    digits = places[len(places) // 2]
    bits = 16 if found else 256
    inverted = int(digits[1], 16) ^ (1 << bits) - 1
    return text[:digits.start(1)] + f"{inverted:0{bits // 4}x}" + text[digits.end(1):]


def build(options, name, texts, pairs):
    """The design with its pairs, verilated and linked with its test."""
    work = options.work / name
    work.mkdir()
    files = []
    for source in options.sources:
        module = pathlib.Path(source).stem
        if module in pairs:
            body, count = re.subn(rf"^module {module}\b", f"module {module}_block", pathlib.Path(source).read_text(), flags=re.M)
            if count != 1:
                sys.exit(f"netlist_blocks: {source} does not hold the module {module} once")
            source = work / f"{module}.sv"
            source.write_text(f"{body}\n{pairs[module]}\n{texts[module]}")
        files.append(source)
    cells = (pathlib.Path(shutil.which(options.yosys)).parent.parent / "share/yosys/ice40/cells_sim.v").read_text()
    for model in options.models:  # Yosys' own of that name is an empty box
        cells = re.sub(rf"^module {pathlib.Path(model).stem}\b", r"\g<0>_EMPTY", cells, flags=re.M)
    (work / "cells.v").write_text(cells)
    # Neither the netlists nor Yosys' cell models are written for our warnings.
    run([options.verilator, "--cc", "--build", "-O3", "--x-assign", "fast", "--x-initial", "fast", "--noassert", "-Wno-fatal",
         "-Wno-lint", "-Wno-style", "-Wno-MULTITOP", "--prefix", options.prefix, "--top-module", options.top, "-Mdir", work / "model",
         "-DNO_ICE40_DEFAULT_ASSIGNMENTS", f"-I{options.include}", "-MAKEFLAGS", "OPT_FAST=-O1", *files, *options.models, work / "cells.v"],
        work / "verilator.log")
    # What the test was compiled with must be what it is linked with.
    if (work / "model" / f"{options.prefix}.h").read_text() != options.header.read_text():
        sys.exit(f"netlist_blocks: {options.header} is another model's")
    model = work / "model" / f"{options.prefix}__ALL.a"
    program = work / "test"
    run([options.compiler, *options.objects, model, "-Wl,--start-group", *options.libraries, model, "-Wl,--end-group",
         "-lgtest_main", "-lgtest", "-lfmt", "-lz", "-lpthread", "-o", program], work / "link.log")
    return program


def simulate(options, program):
    """(what was compared, what differed) by module, over all instances."""
    test = subprocess.run([program, *options.arguments], capture_output=True, text=True)
    compared, differ = collections.Counter(), collections.Counter()
    for module, clocks, bad in LINE.findall(test.stdout):
        compared[module] += int(clocks)
        differ[module] += int(bad)
    if test.returncode:
        sys.exit(f"netlist_blocks: the design's own test fails:\n{(test.stdout + test.stderr)[-2000:]}")
    return compared, differ


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("compiler", "yosys", "verilator", "include", "prefix", "top", "clock"):
        parser.add_argument(f"--{name}", required=True)
    for name in ("sources", "models", "objects", "libraries", "arguments", "skip"):
        parser.add_argument(f"--{name}", type=lambda text: text.split(",") if text else [], default=[])
    parser.add_argument("--blocks", type=pathlib.Path, required=True, help="file with a module a line")
    parser.add_argument("--header", type=pathlib.Path, required=True, help="of the model that the test was compiled with")
    parser.add_argument("--work", type=pathlib.Path, required=True)
    options = parser.parse_args()
    shutil.rmtree(options.work, ignore_errors=True)
    options.work.mkdir(parents=True)
    blocks = [line.split()[0] for line in open(options.blocks) if line.strip() and not line.startswith("#")]
    texts, pairs = {}, {}
    for module in blocks:
        if module in options.skip:
            continue
        texts[module], ports = synthesize(options, module)
        source = next(pathlib.Path(s) for s in options.sources if pathlib.Path(s).stem == module)
        pairs[module] = pair(options, module, ports, dict(re.findall(r"parameter int (\w+) = (\d+)", source.read_text())))
    compared, differ = simulate(options, build(options, "equal", texts, pairs))
    _, caught = simulate(options, build(options, "mutants", {m: mutant(t) for m, t in texts.items()}, pairs))
    failed = False
    for module in texts:
        good = compared[module] and not differ[module] and caught[module]
        failed |= not good
        print(f"{'ok  ' if good else 'BAD '} {module}: {compared[module]} compared, {differ[module]} differ; "
              f"with a cell changed {caught[module]} differ")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())

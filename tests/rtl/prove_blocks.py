#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Proves that a block's netlist for the iCE40 UP5K does what its text says: Yosys' equivalence checking, for all inputs and times.

Every flip-flop, output and net that has one name on both sides must be equal in every clock that follows one in which all
of them were. Then once more with one port of one cell of the netlist inverted: that must not be proved.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys

# Modules that a block is cut from on both sides: their inputs must be equal, their outputs are any. They are products
# (two arrangements of partial products: a proof grows beyond measure with the width), memories (words of which have no
# name in common with a block RAM), or have a proof of their own.
CUT = {
    "hemi_datapath": ["hemi_multiplier", "hemi_nco_table", "hemi_quantiser"],
    "hemi_core": ["hemi_datapath", "hemi_program", "hemi_state_memory"],
    "hemi_axi": ["hemi_core", "hemi_axi_store"],
    "hemi_board": ["hemi_core", "hemi_axi_store", "hemi_link_sender"],
}
# Nets of one name are not equal for themselves here: the outputs are, from any two states, a clock later on.
BY_OUTPUTS = ["hemi_quantiser"]
EQUIVALENCE = ("equiv_make gold gate equiv; hierarchy -top equiv; opt_clean; equiv_simple; equiv_induct; equiv_status -assert",
               r"Of those cells (\d+) are proven and \d+ are unproven")
INDUCTION = ("miter -equiv -flatten gold gate miter; hierarchy -top miter; proc; opt_clean; "
             "sat -verify -seq 1 -prove trigger 0 -tempinduct -maxsteps 3 miter",
             r"Induction step proven|model found|maximum number of time steps")
# Equal wherever the text's signals are defined; with two values alone the induction fails.
DEFINED = ["hemi_link_sender"]
# No proof, but netlist_blocks.py simulates them: products and memories alone.
WITHOUT = ["hemi_multiplier", "hemi_nco_table", "hemi_program", "hemi_sine_rom", "hemi_state_memory", "hemi_axi_store"]


def files_of(options, module):
    """Packages, and the files of a module and of all below it."""
    by_name = {pathlib.Path(s).stem: s for s in options.sources}
    wanted, todo = {name for name in by_name if name.endswith("_pkg")}, [module]
    while todo:
        name = todo.pop()
        if name not in by_name or name in wanted:
            continue
        wanted.add(name)
        todo += re.findall(r"^\s+(hemi_\w+) (?:#\(|i_\w+ \()", pathlib.Path(by_name[name]).read_text(), flags=re.M)
    # A package that names another's constants comes behind it: in the order given.
    return [s for s in options.sources if pathlib.Path(s).stem in wanted]


def prove(options, module, change):
    """True where Yosys proves the module with `change` done to its netlist; and how many signals were proved equal."""
    method, verdict = INDUCTION if module in BY_OUTPUTS else EQUIVALENCE
    if module in DEFINED:
        method = method.replace("equiv_simple;", "equiv_simple -undef;").replace("equiv_induct;", "equiv_induct -undef;")
    cut = CUT.get(module, [])
    kept = "".join(f"design -copy-from text ={name}; " for name in cut)
    script = (f"read_verilog -sv -I{options.include} {' '.join(files_of(options, module))}; "
              + (f"blackbox {' '.join(cut)}; " if cut else "") +
              f"hierarchy -check -top {module}; proc; flatten; opt_clean -purge; design -save rtl; "
              f"synth_ice40 -device u -dsp -top {module}; {change} design -stash netlist; "
              # A table that Yosys takes for a memory goes back into gates.
              "design -load rtl; memory_map; opt_clean -purge; design -stash text; "
              f"design -copy-from text -as gold {module}; design -copy-from netlist -as gate {module}; {kept}"
              "techmap -wb -D EQUIV -autoproc -map +/ice40/cells_sim.v; "
              # The inputs of what is cut become outputs, and the other way round.
              + (f"expose -evert {' '.join(f't:*{name}*' for name in cut)}; " if cut else "")
              + "opt_clean; async2sync; " + method)
    log = options.work / f"{module}{'_changed' if change else ''}.log"
    code = subprocess.run([options.yosys, "-q", "-l", log, "-p", script], capture_output=True).returncode
    text = log.read_text()
    found = re.findall(verdict, text)
    if not found:
        sys.exit(f"prove_blocks: {module}: Yosys failed:\n{text[-2000:]}")
    return not code, f"{found[-1]} signals" if found[-1].isdigit() else "all outputs"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("yosys", "include"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--sources", type=lambda text: text.split(","), required=True)
    parser.add_argument("--blocks", type=pathlib.Path, required=True, help="file with a module a line")
    parser.add_argument("--skip", default="", help="modules to leave out, with commas")
    parser.add_argument("--work", type=pathlib.Path, required=True)
    options = parser.parse_args()
    shutil.rmtree(options.work, ignore_errors=True)
    options.work.mkdir(parents=True)
    blocks = [line.split()[0] for line in open(options.blocks) if line.strip() and not line.startswith("#")]
    failed = False
    for module in blocks:
        if module in WITHOUT or module in options.skip.split(","):
            continue
        proved, what = prove(options, module, "")
        mutation = options.work / f"{module}.ys"
        changed, _ = prove(options, module, f"mutate -list 1 -seed 1 -mode inv -o {mutation}; script {mutation};")
        good = proved and not changed
        failed |= not good
        cut = f", without {', '.join(CUT[module])}" if module in CUT else ""
        print(f"{'ok  ' if good else 'BAD '} {module}{cut}: {'proved' if proved else 'NOT PROVED'} ({what}); "
              f"with an inverted port {'PROVED' if changed else 'not proved'}", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutated copies of the core, each in a namespace of its own, and the table of them.

make_mutant_cores.py HLS_FOLDER MUTATIONS OUTPUT: for mutation i, OUTPUT/tree<i>/hls is the changed copy and OUTPUT/mutant<i>.cpp
compiles it; OUTPUT/mutants.cpp lists them all.
"""
import json
import pathlib
import shutil
import sys

CORE = """// Generated.
#define hemi hemi_mutant_{i}
#include "hls/core.hpp"
#undef hemi
#include "tests/cli/stage/mutant_core.hpp"

namespace hemi_tests_mutant {{
namespace {{
namespace core = hemi_mutant_{i};

struct Silent {{
  template <class T>
  void operator()(core::config::TapIndex, const T&) const {{}}
}};

class Mutated : public Core {{
 public:
  void reset(const std::int64_t* registers) override {{
    std::int64_t image[core::config::register_count];
    for (int i = 0; i < core::config::register_count; ++i) image[i] = registers[i];
    core_.reset(image);
  }}
  bool step(std::int32_t x, std::int32_t y, std::int64_t* words, std::int32_t* dacs) override {{
    Silent probe;
    core::hls::Record record;
    const bool complete = core_.sample(x, y, false, record, probe);
    if (complete)
      for (int i = 0; i < core::config::record_words; ++i) words[i] = record.word[i];
    dacs[0] = core_.dac_drive();
    dacs[1] = core_.dac_rebalance();
    dacs[2] = core_.dac_quadrature();
    return complete;
  }}

 private:
  core::hls::Core<core::config::Reference> core_;
}};
}}  // namespace

std::unique_ptr<Core> make_{i}() {{ return std::make_unique<Mutated>(); }}
}}  // namespace hemi_tests_mutant
"""


def main():
    source, mutations, output = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
    lines = [line.rstrip("\n") for line in open(mutations) if not line.startswith("#")]
    groups = [group.split("\n") for group in "\n".join(lines).strip("\n").split("\n\n")]
    rows, declarations = [], []
    for i, (name, old, new, block) in enumerate(groups):
        tree = output / f"tree{i}"
        shutil.rmtree(tree, ignore_errors=True)
        shutil.copytree(source, tree / "hls")
        target = tree / name
        text = target.read_text()
        if text.count(old) != 1:
            sys.exit(f"{name}: '{old}' stands there {text.count(old)} times, not once")
        target.write_text(text.replace(old, new))
        (output / f"mutant{i}.cpp").write_text(CORE.format(i=i))
        change = json.dumps(f"{name}: {old} -> {new}")
        rows.append(f"      {{{change}, {json.dumps(block)}, hemi_tests_mutant::make_{i}}},")
        declarations.append(f"std::unique_ptr<Core> make_{i}();")
    (output / "mutants.cpp").write_text(
        "// Generated.\n#include \"tests/cli/stage/mutant_core.hpp\"\n\nnamespace hemi_tests_mutant {\n" + "\n".join(declarations)
        + "\n}\n\nnamespace hemi::tests {\nconst std::vector<Mutant>& mutants() {\n  static const std::vector<Mutant> list = {\n"
        + "\n".join(rows) + "\n  };\n  return list;\n}\n}  // namespace hemi::tests\n")


main()

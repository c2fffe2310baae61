// SPDX-License-Identifier: Apache-2.0
#include "tb/verilator_engine.hpp"
#include "tests/tb/mutant_engine.hpp"

namespace hemi::tests {

std::unique_ptr<tb::Engine> make_mutant_engine() {
  return tb::make_rtl_engine(false);
}

}  // namespace hemi::tests

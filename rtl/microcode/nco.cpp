// SPDX-License-Identifier: Apache-2.0
//
// nco: phase accumulator, sine and cosine from the quarter-wave table.
//
//   cos, sin = cos, sin(2 pi (phase + 2^-25));  phase += increment
//
// in       increment Q1.48 turns a sample
// out      phase Q5.48 turns, cos and sin Q1.19
// clocks   6 a sample
// rounding the lookup's; phase wraps at 32 turns
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {

void nco(Assembler& m) {
  m.block("nco");
  const Word phase = m.word("phase");
  m.look_up(m.word("cos"), phase, true).send_to(config::tap_cos);
  m.look_up(m.word("sin"), phase, false).send_to(config::tap_sin);
  m.move(m.nowhere(), phase).send_to(config::tap_phase);
  m.add(phase, phase, m.word("increment")).wrap(config::phase);
}

}  // namespace hemi::microcode

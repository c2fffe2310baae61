// SPDX-License-Identifier: Apache-2.0
//
// frequency_tracker: frequency from the total phase, nco plus detector.
//
//   P_k = (phase_{k-4} + phase_{k-5}) / 2 + phase_error_k,  sum of 25 unwrapped P, differenced
//
// in       nco phase after the tick Q5.48, phase_error Q0.32, amplitude Q2.32, once a tick
// out      frequency Q17.29 in nominal Hz; sums of 50 amplitudes, phase errors, drive and quadrature
//          commands, once an output
// clocks   16 a tick, 15 an output
// rounding phase cut to 2^-32 turns; all words wrap
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

constexpr int delay = 4;  ///< ticks from the nco's phase to the detector's

void sum_up(Assembler& m, const std::string& name, const char* term) {
  const Word sum = m.word(name + "_interval");
  m.add(sum, sum, m.word(term));
}

void sum_of_two(Assembler& m, const std::string& name) {
  const Word sum = m.word(name + "_interval");
  const Word last = m.word("last_" + name + "_interval");
  m.add(m.word(name + "_word"), sum, last);
  m.move(last, sum);
  m.clear(sum);
}

}  // namespace

void frequency_tracker_tick(Assembler& m) {
  m.block("frequency_tracker");
  const Word phase = m.word("phase");
  const Word last = m.word("last_phase");
  const Word middle = m.word("middle_phase");
  const Word tick_phase = m.word("tick_phase");
  const Word advance = m.word("tick_advance");
  const Word total = m.word("total_phase");
  const auto centre = [&](int ticks) { return m.word("centre_phase", ticks); };
  m.subtract(middle, phase, last).wrap(config::phase);
  m.move(last, phase);
  m.subtract(middle, last, middle).floor(1).wrap(config::phase);
  m.add(tick_phase, centre(delay), m.word("phase_error"))
      .wrap(config::tick_phase)
      .send_to(config::tap_tick_phase);
  for (int ticks = delay; ticks > 1; --ticks) m.move(centre(ticks), centre(ticks - 1));
  m.move(centre(1), middle).floor(config::phase.fraction - config::tick_phase.fraction);
  m.subtract(advance, tick_phase, m.word("last_tick_phase")).wrap(config::tick_phase);
  m.move(m.word("last_tick_phase"), tick_phase);
  m.add(total, total, advance).wrap(config::total_phase);
  m.add(m.word("phase_sum"), m.word("phase_sum"), total).wrap(config::total_phase);
  sum_up(m, "amplitude", "amplitude");
  sum_up(m, "error", "phase_error");
  sum_up(m, "drive", "drive");
  sum_up(m, "quadrature", "quadrature");
}

void frequency_tracker_output(Assembler& m) {
  m.block("frequency_tracker");
  const Word sum = m.word("phase_sum");
  const Word last = m.word("last_phase_sum");
  m.subtract(m.word("frequency"), sum, last).wrap(config::frequency).send_to(config::tap_frequency);
  m.move(last, sum);
  m.clear(sum);
  for (const char* name : {"amplitude", "error", "drive", "quadrature"}) sum_of_two(m, name);
}

}  // namespace hemi::microcode

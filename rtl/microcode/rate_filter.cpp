// SPDX-License-Identifier: Apache-2.0
//
// rate_filter: two integrators at the loop rate, two combs at the output rate.
//
//   rate = (1 + z^-1 + ... + z^-24)^2 rate_tick
//
// in       secondary_in_phase Q1.27 or, closed loop, rebalance Q2.30, times rate_gain Q11.13
// out      rate_tick Q11.26 of 625 deg/h a tick; rate Q20.16 deg/h an output
// clocks   7 a tick, 5 an output
// rounding rate_tick and rate half up, clipped (rate_saturated); sums wrap
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {

void rate_filter_tick(Assembler& m) {
  m.block("rate_filter");
  const Word tick = m.word("rate_tick");
  const Word first = m.word("rate_sum", 1);
  const Word second = m.word("rate_sum", 2);
  const auto take = [&](const char* source, config::Format format) -> Instruction& {
    const int fraction = format.fraction + config::registers[config::reg_rate_gain].format.fraction;
    return m.move(tick, m.product(m.word(source), m.reg(config::reg_rate_gain)))
        .round(fraction - config::rate_tick.fraction)
        .saturate(config::rate_tick)
        .raise(config::status_rate_saturated)
        .send_to(config::tap_rate_tick);
  };
  m.test(m.word("closed_loop"));
  take("secondary_in_phase", config::baseband).if_not_negative();
  take("rebalance", config::command).if_negative();
  m.add(first, first, tick).wrap(config::rate_accumulator);
  m.add(second, second, first).wrap(config::rate_accumulator);
}

void rate_filter_output(Assembler& m) {
  m.block("rate_filter");
  const Word sum = m.word("rate_sum", 2);
  const Word first = m.word("rate_difference", 1);
  const Word second = m.word("rate_difference", 2);
  m.subtract(first, sum, m.word("last_rate_sum")).wrap(config::rate_accumulator);
  m.move(m.word("last_rate_sum"), sum);
  m.subtract(second, first, m.word("last_rate_difference")).wrap(config::rate_accumulator);
  m.move(m.word("last_rate_difference"), first);
  m.move(m.word("rate"), second)
      .round(config::rate_accumulator.fraction - config::rate.fraction)
      .saturate(config::rate)
      .raise(config::status_rate_saturated)
      .send_to(config::tap_rate);
}

}  // namespace hemi::microcode

// SPDX-License-Identifier: Apache-2.0
//
// thermometer: temperature from frequency.
//
//   offset = (frequency - frequency_reference) / 64 Hz;  temperature = sum_i thermometer_i offset^i, i = 0..5
//
// in       frequency Q17.29 nominal Hz
// out      offset Q1.23, temperature Q13.19 degC
// clocks   14 an output
// rounding half up and clipped at each step (frequency_out_of_range, thermometer_saturated)
// source   Horner's scheme
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {

void thermometer(Assembler& m) {
  m.block("thermometer");
  const Word difference = m.word("frequency_difference");
  const Word offset = m.word("offset");
  const Word temperature = m.word("temperature");
  static_assert(config::offset_span_hz == 64, "six bits of the shift below");
  constexpr int offset_fraction = config::offset.fraction - 6;
  m.subtract(difference, m.word("frequency"), m.reg(config::reg_frequency_reference));
  m.move(offset, difference)
      .round(config::frequency.fraction - offset_fraction)
      .saturate(config::offset)
      .raise(config::status_frequency_out_of_range)
      .send_to(config::tap_offset);
  Word sum = m.reg(config::reg_thermometer_5);
  for (int i = 4; i >= 0; --i) {
    const Word coefficient = m.reg(static_cast<config::RegisterIndex>(config::reg_thermometer_0 + i));
    Instruction& step = m.add(temperature, coefficient, m.product(sum, offset))
                            .round(config::offset.fraction)
                            .saturate(config::temperature)
                            .raise(config::status_thermometer_saturated);
    if (i == 0) step.send_to(config::tap_temperature);
    sum = temperature;
  }
  m.subtract(m.nowhere(), offset, m.reg(config::reg_calibrated_low))
      .raise(config::status_out_of_calibrated_range);
  m.subtract(m.nowhere(), m.reg(config::reg_calibrated_high), offset)
      .raise(config::status_out_of_calibrated_range);
}

}  // namespace hemi::microcode

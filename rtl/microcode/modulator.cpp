// SPDX-License-Identifier: Apache-2.0
//
// modulator: commands onto the carrier, as DAC words.
//
//   dac = round(-command sin(2 pi (phase + offset)) + error),  error = what that rounding left
//   offset = modulation_phase + modulation_delay increment
//
// in       drive, rebalance, quadrature Q2.30, nco phase Q5.48 turns, pending increment Q1.48
// out      DAC words Q1.15 at dac_.._port, drive before rebalance; quadrature once a tick, without carrier
// clocks   12 a sample, 12 a tick
// rounding product half up to 2^-30; word half up to 2^-15 and clipped, its error goes to the next word
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

constexpr int dac_shift = config::dac_sum.fraction - config::dac.fraction;

}  // namespace

/// In front of the nco's step: reads its phase.
void modulator_carrier(Assembler& m) {
  m.block("modulator");
  const Word phase = m.word("carrier_phase");
  m.add(phase, m.word("phase"), m.word("offset_in_force"));
  m.look_up(m.word("carrier"), phase, false).send_to(config::tap_carrier);
  // The negative of the factor, not of the product: halves are rounded up.
  m.subtract(m.word("velocity"), m.zero(), m.word("carrier"));
}

void modulator_sample(Assembler& m) {
  m.block("modulator");
  constexpr int shift = config::command.fraction + config::sine.fraction - config::dac_sum.fraction;
  const auto modulate = [&](const char* command, Word port, config::TapIndex tap) {
    const std::string name = command;
    const Word sum = m.word(name + "_dac_sum");
    const Word error = m.word(name + "_dac_error");
    m.add(sum, error, m.product(m.word(name + "_in_force"), m.word("velocity"))).round(shift);
    m.shape(port, error, sum, dac_shift, config::dac).send_to(tap);
  };
  modulate("drive", dac_drive_port, config::tap_dac_drive);
  modulate("rebalance", dac_rebalance_port, config::tap_dac_rebalance);
}

/// What the tick before computed comes into force.
void modulator_take_over(Assembler& m) {
  m.block("modulator");
  m.move(m.word("drive_in_force"), m.word("drive"));
  m.move(m.word("rebalance_in_force"), m.word("rebalance"));
  m.move(m.word("offset_in_force"), m.word("pending_offset"));
  m.move(dac_quadrature_port, m.word("pending_dac_quadrature"));
}

void modulator_tick(Assembler& m) {
  m.block("modulator");
  constexpr config::Format delay = config::registers[config::reg_modulation_delay].format;
  const Word operand = m.word("increment_operand");
  const Word offset = m.word("carrier_offset");
  const Word sum = m.word("quadrature_dac_sum");
  const Word error = m.word("quadrature_dac_error");
  m.move(operand, m.word("pending")).floor(config::increment.fraction - config::increment_operand.fraction);
  m.add(offset, m.reg(config::reg_modulation_phase), m.product(operand, m.reg(config::reg_modulation_delay)))
      .round(config::increment_operand.fraction + delay.fraction - config::angle.fraction)
      .wrap(config::angle)
      .send_to(config::tap_carrier_offset);
  m.move(m.word("pending_offset"),
         m.product(offset, m.constant(std::int64_t{1} << (config::phase.fraction - config::angle.fraction))));
  m.add(sum, m.word("quadrature"), error);
  m.shape(m.word("pending_dac_quadrature"), error, sum, dac_shift, config::dac)
      .send_to(config::tap_dac_quadrature);
}

}  // namespace hemi::microcode

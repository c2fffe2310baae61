// SPDX-License-Identifier: Apache-2.0
//
// bias_model: the ten terms of Eq. (21) in offset o and derivative g, and the compensated rate.
//
//   B = B0 + k1 o + k2 o^2 + k3 o^3 + k4 g + k5 g^2 + k6 g^3 + k7 o g + k8 o^2 g + k9 o g^2
//   compensated = (rate - B) (1 + scale_correction)
//
// in       offset, derivative Q1.23; coefficients Q19.13 deg/h; rate Q20.16 deg/h
// out      bias Q19.13, compensated Q20.16 deg/h
// clocks   24 an output
// rounding half up and clipped at each step (bias_saturated, compensation_saturated)
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

void step(Assembler& m, Word dst, Word factor, const char* variable, Word addend) {
  m.add(dst, addend, m.product(factor, m.word(variable)))
      .round(config::offset.fraction)
      .saturate(config::bias)
      .raise(config::status_bias_saturated);
}

void compensate(Assembler& m, Word bias) {
  const Word exact = m.word("exact_rate");
  const Word operand = m.word("scale_operand");
  const Word up = m.constant(std::int64_t{1} << (config::rate.fraction - config::bias.fraction));
  constexpr int fraction =
      config::scale_operand.fraction + config::registers[config::reg_scale_correction].format.fraction;
  m.subtract(exact, m.word("rate"), m.product(bias, up));
  m.move(operand, exact).floor(config::rate.fraction - config::scale_operand.fraction);
  m.add(m.word("compensated"), exact, m.product(operand, m.reg(config::reg_scale_correction)))
      .round(fraction - config::rate.fraction)
      .saturate(config::rate)
      .raise(config::status_compensation_saturated)
      .send_to(config::tap_compensated);
}

}  // namespace

void bias_model(Assembler& m) {
  m.block("bias_model");
  static_assert(config::offset.fraction == config::derivative.fraction, "one shift serves both");
  const Word p = m.word("bias_p");
  const Word a = m.word("bias_a");
  const Word b = m.word("bias_b");
  const Word bias = m.word("bias");
  step(m, p, m.reg(config::reg_bias_f3), "offset", m.reg(config::reg_bias_f2));
  step(m, p, p, "offset", m.reg(config::reg_bias_f));
  step(m, a, m.reg(config::reg_bias_df3), "derivative", m.reg(config::reg_bias_df2));
  step(m, a, m.reg(config::reg_bias_f_df2), "offset", a);
  step(m, b, m.reg(config::reg_bias_f2_df), "offset", m.reg(config::reg_bias_f_df));
  step(m, b, b, "offset", m.reg(config::reg_bias_df));
  step(m, b, a, "derivative", b);
  step(m, bias, b, "derivative", m.reg(config::reg_bias_0));
  step(m, bias, p, "offset", bias);
  m.move(m.nowhere(), bias).send_to(config::tap_bias);
  compensate(m, bias);
}

}  // namespace hemi::microcode

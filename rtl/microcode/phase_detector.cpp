// SPDX-License-Identifier: Apache-2.0
//
// phase_detector: CORDIC vectoring of the primary; the secondary turned by the demodulation phase.
//
//   amplitude = K |I + jQ|, phase_error = atan2(Q, I) / (2 pi);  in_phase + j quadrature = (yi + j yq) e^(-j
//   phase)
//
// in       baseband_.. Q1.27; demodulation_cos, _sin Q2.22
// out      amplitude Q2.32, K = prod sqrt(1 + 4^-i); phase_error Q0.32 turns; secondary Q1.27
// clocks   89 a tick
// rounding CORDIC shifts floor, the angle wraps; secondary half up, clipped (secondary_saturated)
// source   J. E. Volder, The CORDIC trigonometric computing technique, 1959
#include <cmath>
#include <numbers>

#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

std::int64_t cordic_angle(int i) {
  const long double turns = std::atan(std::ldexp(1.0L, -i)) / (2 * std::numbers::pi_v<long double>);
  return std::llround(std::ldexp(turns, config::angle.fraction));
}

void vectoring(Assembler& m) {
  const Word scale = m.constant(std::int64_t{1} << (config::cordic.fraction - config::baseband.fraction));
  const Word x[] = {m.word("cordic_x", 0), m.word("cordic_x", 1)};
  const Word y[] = {m.word("cordic_y", 0), m.word("cordic_y", 1)};
  const Word z = m.word("phase_error");
  m.add(y[1], m.zero(), m.product(m.word("baseband", 1), scale));
  m.add(x[1], m.zero(), m.product(m.word("baseband", 0), scale)).set_negative();
  m.subtract_if_negative(x[0], m.zero(), x[1]);
  m.clear(z);
  m.move(z, m.constant(-(std::int64_t{1} << (config::angle.width - 1)))).if_negative();
  m.subtract_if_negative(y[0], m.zero(), y[1]).set_negative();
  for (int i = 0; i < config::cordic_iterations; ++i) {
    const int from = i % 2;
    const bool last = i + 1 == config::cordic_iterations;
    Instruction& new_x =
        m.subtract_if_negative(last ? m.word("amplitude") : x[1 - from], x[from], y[from]).floor(i);
    Instruction& new_z = m.subtract_if_negative(z, z, m.constant(cordic_angle(i))).wrap(config::angle);
    if (last) {
      new_x.send_to(config::tap_amplitude);
      new_z.send_to(config::tap_phase_error);
    } else {
      m.add_if_negative(y[1 - from], y[from], x[from]).floor(i).set_negative();
    }
  }
}

void rotate(Assembler& m) {
  const Word i = m.word("baseband", 2);
  const Word q = m.word("baseband", 3);
  const Word cosine = m.reg(config::reg_demodulation_cos);
  const Word sine = m.reg(config::reg_demodulation_sin);
  const int shift = config::registers[config::reg_demodulation_cos].format.fraction;
  const Word exact[] = {m.word("rotated", 0), m.word("rotated", 1)};
  m.add(exact[0], m.zero(), m.product(i, cosine));
  m.add(exact[1], m.zero(), m.product(q, cosine));
  m.add(exact[0], exact[0], m.product(q, sine));
  m.subtract(exact[1], exact[1], m.product(i, sine));
  m.move(m.word("secondary_in_phase"), exact[0])
      .round(shift)
      .saturate(config::baseband)
      .raise(config::status_secondary_saturated)
      .send_to(config::tap_secondary_in_phase);
  m.move(m.word("secondary_quadrature"), exact[1])
      .round(shift)
      .saturate(config::baseband)
      .raise(config::status_secondary_saturated)
      .send_to(config::tap_secondary_quadrature);
}

}  // namespace

void phase_detector(Assembler& m) {
  m.block("phase_detector");
  vectoring(m);
  rotate(m);
}

}  // namespace hemi::microcode

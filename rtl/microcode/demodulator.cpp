// SPDX-License-Identifier: Apache-2.0
//
// demodulator: both pickoffs times both phases of the nco.
//
//   xi = x cos, xq = -x sin, yi = y cos, yq = -y sin
//
// in       x, y: ADC words Q1.(adc_bits - 1); cos, sin Q1.19
// out      products Q1.23
// clocks   10 a sample
// rounding half up to 2^-23; cannot overflow
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {

void demodulator(Assembler& m) {
  m.block("demodulator");
  const int shift = m.instrument().adc_bits - 1 + config::sine.fraction - config::product.fraction;
  m.move(m.word("x"), sample_x_port);
  m.move(m.word("y"), sample_y_port).then(Control::take);
  const Word cosine = m.word("cos");
  const Word sine = m.word("sin");
  const char* const pickoffs[] = {"x", "y"};
  for (int i = 0; i < 2; ++i) {
    const Word pickoff = m.word(pickoffs[i]);
    const int tap = config::tap_product_xi + 2 * i;
    m.add(m.word("product", 2 * i), m.zero(), m.product(cosine, pickoff))
        .round(shift)
        .send_to(static_cast<config::TapIndex>(tap));
    m.subtract(m.word("product", 2 * i + 1), m.zero(), m.product(sine, pickoff))
        .round(shift)
        .send_to(static_cast<config::TapIndex>(tap + 1));
  }
}

}  // namespace hemi::microcode

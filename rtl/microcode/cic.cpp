// SPDX-License-Identifier: Apache-2.0
//
// cic: four channels of five integrators and five combs, decimation R.
//
//   v = s5 conv (1 - z^-R)^5, the products convolved with (1 + z^-1 + ... + z^-(R-1))^5
//
// in       products Q1.23, once a sample
// out      cic_.. Q1.27 of R^5 2^-growth full scale, once a tick
// clocks   20 a sample, 44 a tick
// rounding none inside, modulo 2^cic_bits; output half up
// source   E. B. Hogenauer, An economical class of digital filters for decimation and interpolation, 1981
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

Word integrator(Assembler& m, int channel, int stage) {
  return m.word(std::string("integrator_") + channel_names[channel], stage);
}

}  // namespace

void cic_sample(Assembler& m) {
  m.block("cic");
  for (int channel = 0; channel < channels; ++channel) {
    Word in = m.word("product", channel);
    for (int stage = 0; stage < config::cic_order; ++stage) {
      const Word sum = integrator(m, channel, stage);
      m.add(sum, sum, in).wrap(m.instrument().cic_bits);
      in = sum;
    }
  }
}

void cic_tick(Assembler& m) {
  m.block("cic");
  for (int channel = 0; channel < channels; ++channel) {
    Word in = integrator(m, channel, config::cic_order - 1);
    for (int stage = 0; stage < config::cic_order; ++stage) {
      const Word delayed = m.word(std::string("comb_") + channel_names[channel], stage);
      const Word out = m.word("difference_" + std::to_string(channel), stage % 2);
      m.subtract(out, in, delayed).wrap(m.instrument().cic_bits);
      m.move(delayed, in);
      in = out;
    }
    m.move(m.word("cic", channel), in)
        .round(m.instrument().cic_bits - config::baseband.width)
        .send_to(static_cast<config::TapIndex>(config::tap_cic_xi + channel));
  }
}

}  // namespace hemi::microcode

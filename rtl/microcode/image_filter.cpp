// SPDX-License-Identifier: Apache-2.0
//
// image_filter: double zero where the image at twice the carrier folds to.
//
//   baseband[k] = (16 u[k] - 8 u[k-1] + 33 u[k-2] - 8 u[k-3] + 16 u[k-4]) / 64
//
// in       u = cic_.. Q1.27
// out      baseband_.. Q1.27
// clocks   48 a tick
// rounding half up, once: (8 w + v) / 64 with w = 2 a - b + 4 v, a = u + u[-4], b = u[-1] + u[-3], v = u[-2],
// and
//          rounding w + floor(v / 8) at 3 bits is rounding 8 w + v at 6
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {

void image_filter(Assembler& m) {
  m.block("image_filter");
  static_assert(config::image_taps[0] == 16 && config::image_taps[1] == -8 && config::image_taps[2] == 33 &&
                    config::image_taps[3] == -8 && config::image_taps[4] == 16 && config::image_shift == 6,
                "the sums below are these taps");
  for (int channel = 0; channel < channels; ++channel) {
    const std::string name = channel_names[channel];
    const Word newest = m.word("cic", channel);
    const auto delayed = [&](int ticks) { return m.word("delayed_" + name, ticks); };
    const Word outer = m.word("outer", channel);
    const Word inner = m.word("inner", channel);
    m.add(outer, newest, delayed(4));
    m.add(inner, delayed(1), delayed(3));
    m.add(outer, outer, delayed(2));
    m.add(outer, outer, delayed(2));
    m.add(outer, outer, outer);
    m.subtract(outer, outer, inner);
    m.add(outer, outer, delayed(2)).floor(3);
    m.move(m.word("baseband", channel), outer)
        .round(3)
        .send_to(static_cast<config::TapIndex>(config::tap_baseband_xi + channel));
    for (int ticks = 4; ticks > 1; --ticks) m.move(delayed(ticks), delayed(ticks - 1));
    m.move(delayed(1), newest);
  }
}

}  // namespace hemi::microcode

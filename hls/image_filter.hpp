// SPDX-License-Identifier: Apache-2.0
//
// image_filter: removes what is left of the image at twice the carrier, folded to about 1150 Hz of 5 kHz.
//
//   H(z) = (4 - z^-1 + 4 z^-2)^2 / 64: a double zero at acos(1/8) / (2 pi) = 0.2301 of the loop rate
//
// in, out  baseband Q1.27; gain 49/64 at 0 Hz, -0.16 dB more at 100 Hz
// delay    2 ticks
// rounding half up; cannot overflow: the taps sum to 81/64, the cic's output stays below 0.78
#ifndef HEMI_HLS_IMAGE_FILTER_HPP
#define HEMI_HLS_IMAGE_FILTER_HPP

#include "hls/words.hpp"

namespace hemi {
namespace hls {

class ImageFilter {
 public:
  void reset() {
    for (int i = 0; i < 4; ++i) history_[i] = Baseband();
  }

  Baseband step(const Baseband& input) {
    using Tap = Fixed<7, 7>;
    using Sum = Fixed<config::baseband.width + 8, 9>;
    Sum sum = quantise<Sum>(input * from_raw<Tap>(config::image_taps[0]));
    for (int i = 0; i < 4; ++i)
      sum = wrap_add(sum, quantise<Sum>(history_[i] * from_raw<Tap>(config::image_taps[i + 1])));
    for (int i = 3; i > 0; --i) history_[i] = history_[i - 1];
    history_[0] = input;
    return quantise<Baseband>(quantise<Rounded<config::baseband>>(scale<-config::image_shift>(sum)));
  }

 private:
  Baseband history_[4];
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_IMAGE_FILTER_HPP

// SPDX-License-Identifier: Apache-2.0
//
// thermometer: temperature of the resonator from its frequency.
//
//   T = sum_i t_i o^i, i = 0..5, o = (f - f_reference) / 64 Hz
//
// in       frequency Q17.29 nominal Hz
// out      offset o Q1.23 (7.6 uHz), temperature Q13.19 degC (1.9e-6 degC)
// latency  within the output
// rounding offset half up, clipped beyond 64 Hz (flag); each Horner step half up, clipped (flag)
// source   the paper, Eq. (16)-(18), inverted
#ifndef HEMI_HLS_THERMOMETER_HPP
#define HEMI_HLS_THERMOMETER_HPP

#include "hls/registers.hpp"

namespace hemi {
namespace hls {

/// One step of a Horner scheme: clip(round(factor x) + addend), all on the grid of `F`.
template <const config::Format& F, class X>
Word<F> horner(const Word<F>& factor, const X& x, const Word<F>& addend, bool& saturated) {
  using Wide = Fixed<F.width + 2, F.width + 2 - F.fraction, Round::half_up>;
  const Wide product = quantise<Wide>(factor * x);
  return clip<Word<F>, Clipped<F>>(product + addend, saturated);
}

struct Thermometer {
  using Difference =
      Fixed<config::frequency.width + 1, config::frequency.width + 1 - config::frequency.fraction>;

  static Difference difference(const Frequency& frequency, const Registers& r) {
    return quantise<Difference>(frequency - r.frequency_reference);
  }

  static Offset offset(const Difference& difference, bool& out_of_range) {
    // 64 Hz is 2^6: the offset in units of 64 Hz is the same word with its point moved.
    return clip<Offset, Clipped<config::offset>>(scale<-6>(difference), out_of_range);
  }

  static Temperature temperature(const Offset& offset, const Registers& r, bool& saturated) {
    Temperature t = r.thermometer[5];
    for (int i = 4; i >= 0; --i) t = horner<config::temperature>(t, offset, r.thermometer[i], saturated);
    return t;
  }
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_THERMOMETER_HPP

// SPDX-License-Identifier: Apache-2.0
//
// bias_model: the rate's temperature drift, all ten terms of Eq. (21), and the compensated rate.
//
//   B = B0 + k1 o + k2 o^2 + k3 o^3 + k4 g + k5 g^2 + k6 g^3 + k7 o g + k8 o^2 g + k9 o g^2,  compensated =
//   (rate - B) (1 + correction)
//
// in       offset o Q1.23 (64 Hz), derivative g Q1.23, rate Q20.16 deg/h; coefficients Q19.13 deg/h;
// correction out      bias Q19.13 deg/h, compensated rate Q20.16 deg/h latency  within the output
// rounding each product half up to 2^-13 deg/h, each sum clipped (flag); correction product half up to 2^-16
// source   the paper, Eq. (21)
#ifndef HEMI_HLS_BIAS_MODEL_HPP
#define HEMI_HLS_BIAS_MODEL_HPP

#include "hls/thermometer.hpp"

namespace hemi {
namespace hls {

struct BiasModel {
  static Bias bias(const Offset& o, const Derivative& g, const Registers& r, bool& saturated) {
    const Bias* k = r.bias;
    Bias p = step(k[3], o, k[2], saturated);
    p = step(p, o, k[1], saturated);
    Bias a = step(k[6], g, k[5], saturated);
    a = step(k[9], o, a, saturated);
    Bias b = step(k[8], o, k[7], saturated);
    b = step(b, o, k[4], saturated);
    const Bias c = step(a, g, b, saturated);
    const Bias sum = step(c, g, k[0], saturated);
    return step(p, o, sum, saturated);
  }

  static Rate compensate(const Rate& rate, const Bias& bias, const Registers& r, bool& saturated) {
    using Difference = Fixed<config::rate.width + 1, config::rate.width + 1 - config::rate.fraction>;
    const Difference difference = quantise<Difference>(rate - bias);
    const Word<config::scale_operand> operand = quantise<Word<config::scale_operand>>(difference);
    const Rounded<config::rate> correction = quantise<Rounded<config::rate>>(operand * r.scale_correction);
    return clip<Rate, Clipped<config::rate>>(difference + correction, saturated);
  }

 private:
  template <class X>
  static Bias step(const Bias& factor, const X& x, const Bias& addend, bool& saturated) {
    return horner<config::bias>(factor, x, addend, saturated);
  }
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_BIAS_MODEL_HPP

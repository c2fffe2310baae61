// SPDX-License-Identifier: Apache-2.0
//
// cic: cascaded integrator-comb decimator of order 5.
//
//   H(z) = ((1 - z^-R) / (1 - z^-1))^5, R = decimation
//
// in       product Q1.23 at the ADC rate
// out      baseband Q1.27 at the loop rate, gain R^5 / 2^g with g = growth bits: 0.763 (R = 20), 0.582 (R =
// 50) delay    5 (R - 1) / 2 samples; one output every R samples rounding none inside (words of 24 + g bits
// wrap and the combs undo it); output rounded half up, cannot overflow rejects  (sin(pi f R / fs) / (R sin(pi
// f / fs)))^5: the image at 2 x 4425 Hz by 92 dB source   E. B. Hogenauer, An economical class of digital
// filters for decimation and interpolation, 1981
#ifndef HEMI_HLS_CIC_HPP
#define HEMI_HLS_CIC_HPP

#include "hls/words.hpp"

namespace hemi {
namespace hls {

template <class Instrument>
class Cic {
 public:
  using Accumulator = Fixed<Instrument::cic_bits, Instrument::cic_bits - config::product.fraction>;

  void reset() {
    for (int i = 0; i < config::cic_order; ++i) {
      integrator_[i] = Accumulator();
      comb_[i] = Accumulator();
    }
  }

  void integrate(const Product& product) {
    integrator_[0] = wrap_add(integrator_[0], product);
    for (int i = 1; i < config::cic_order; ++i) integrator_[i] = wrap_add(integrator_[i], integrator_[i - 1]);
  }

  Baseband decimate() {
    Accumulator value = integrator_[config::cic_order - 1];
    for (int i = 0; i < config::cic_order; ++i) {
      const Accumulator difference = wrap_sub(value, comb_[i]);
      comb_[i] = value;
      value = difference;
    }
    return quantise<Baseband>(quantise<Rounded<config::baseband>>(scale<-Instrument::cic_growth>(value)));
  }

 private:
  Accumulator integrator_[config::cic_order];
  Accumulator comb_[config::cic_order];
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_CIC_HPP

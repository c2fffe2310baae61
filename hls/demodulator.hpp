// SPDX-License-Identifier: Apache-2.0
//
// demodulator: both pickoffs times both phases of the nco.
//
//   xi = x cos, xq = -x sin, yi = y cos, yq = -y sin
//
// in       x, y Q1.(adc_bits-1) of full scale; cos, sin Q1.19
// out      four products Q1.23
// latency  0 samples, interval 1
// rounding half up to 2^-23, before the sign of the sine products; cannot overflow, as |cos|, |sin| < 1
#ifndef HEMI_HLS_DEMODULATOR_HPP
#define HEMI_HLS_DEMODULATOR_HPP

#include "hls/nco.hpp"

namespace hemi {
namespace hls {

/// Four channels in the order primary in phase, primary quadrature, secondary in phase, secondary quadrature.
constexpr int channels = 4;

template <class Instrument>
struct Demodulator {
  using Adc = Fixed<Instrument::adc_bits, 1>;

  static void mix(const Adc& x, const Adc& y, const SinCos& nco, Product (&products)[channels]) {
    products[0] = product(x, nco.cosine);
    products[1] = quantise<Product>(-product(x, nco.sine));
    products[2] = product(y, nco.cosine);
    products[3] = quantise<Product>(-product(y, nco.sine));
  }

 private:
  static Product product(const Adc& sample, const Sine& phase) {
    return quantise<Product>(quantise<Rounded<config::product>>(sample * phase));
  }
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_DEMODULATOR_HPP

// SPDX-License-Identifier: Apache-2.0
// ADC and DAC.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "hls/config.hpp"

namespace hemi::physics {

struct AdcConfiguration {
  int bits;
  double rate_hz;  ///< by the board's clock

  static constexpr AdcConfiguration reference() {
    return {config::Reference::adc_bits, config::Reference::adc_rate_hz};
  }
  static constexpr AdcConfiguration wide() { return {config::Wide::adc_bits, config::Wide::adc_rate_hz}; }
};

/// One sample of both pickoffs, ADC words.
struct AdcPair {
  std::int32_t x;
  std::int32_t y;
};

/// Words of the 16 bit DACs; word / 2^15 is the fraction of full scale. Drive and rebalance are the waveforms
/// themselves, quadrature is the slow electrode.
struct DacWords {
  std::int16_t drive = 0;
  std::int16_t rebalance = 0;
  std::int16_t quadrature = 0;
};

inline constexpr double dac_fraction(std::int16_t word) {
  return word * 0x1p-15;
}

/// Integral non-linearity of an ADC whose four upper bits have wrong weights, the end points adjusted:
/// largest magnitude 1. position: 0..1 from the lowest code to the highest. It is bound to the codes: steps
/// at multiples of 1/16 of the range.
double integral_nonlinearity(double position);

/// word = round(clip(v) 2^(bits-1) + offset + noise + peak INL), half up, held at the rails. v: fraction of
/// full scale, clip: by the front end at +-level. The rest is in codes.
class Adc {
 public:
  explicit Adc(int bits)
      : full_scale_(static_cast<double>(1 << (bits - 1))),
        codes_per_lsb16_(static_cast<double>(1 << (bits - 16))) {}

  /// Codes a 16 bit LSB.
  double codes_per_lsb16() const { return codes_per_lsb16_; }

  /// offset and inl_peak: 16 bit LSB. clip: fraction of full scale, > 0.
  void set(double offset_lsb, double inl_peak_lsb, double clip) {
    offset_ = offset_lsb * codes_per_lsb16_;
    inl_peak_ = inl_peak_lsb * codes_per_lsb16_;
    clip_ = clip;
  }

  std::int32_t convert(double fraction, double noise_codes) const {
    double codes = std::clamp(fraction, -clip_, clip_) * full_scale_ + offset_ + noise_codes;
    if (inl_peak_ != 0.0) codes += inl_peak_ * integral_nonlinearity(codes / (2.0 * full_scale_) + 0.5);
    // positive before the cast, which cuts towards zero
    const double above_rail = std::clamp(codes + full_scale_ + 0.5, 0.0, 2.0 * full_scale_ - 0.5);
    return static_cast<std::int32_t>(above_rail) - static_cast<std::int32_t>(full_scale_);
  }

 private:
  double full_scale_;
  double codes_per_lsb16_;
  double offset_ = 0.0;
  double inl_peak_ = 0.0;
  double clip_ = 1.0;
};

}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "golden/physics/instrument.hpp"

namespace hemi::physics {

/// Fundamental of what the primary's channel measures, as a function of the true amplitude, and its inverse:
/// the amplitude loop holds the measured one. Describing functions, in fractions of the ADC's full scale:
///
///     pickoff    u = full_scale_per_amplitude gain A (1 + (3/4) a3 A^2)
///     clipping   u > c:  u (2/pi) (asin(c/u) + (c/u) sqrt(1 - (c/u)^2))
///     INL        a step by j at level l: + j (2/pi) sqrt(1 - (l/u)^2) where |l| < u; a slope s: + s u
///
/// (Gelb and Vander Velde, Multiple-Input Describing Functions, 1968, for the last two.)
class PickoffCurve {
 public:
  explicit PickoffCurve(const Instrument& instrument);

  /// Measured amplitude [nominal amplitudes].
  double measured(double amplitude, const Parameters& p) const;
  /// True amplitude. Throws std::invalid_argument where the front end clips too low for it.
  double amplitude(double measured, const Parameters& p) const;

 private:
  static constexpr int kSteps = 15;  ///< of the ADC's INL, at multiples of 1/16 of its range
  double converted(double fraction, const Parameters& p) const;

  double full_scale_per_amplitude_;
  double inl_slope_;  ///< per unit of fraction, for a peak of 1 LSB
  std::array<double, kSteps> inl_step_{};
};

}  // namespace hemi::physics

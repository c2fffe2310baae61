// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "hls/config.hpp"

namespace hemi::golden {

/// ideal: real numbers, as far as doubles reach. quantised: every word on the grid of its format.
enum class Precision { ideal, quantised };

/// 2^exponent, exact.
inline double power_of_two(int exponent) {
  return std::ldexp(1.0, exponent);
}

/// Largest multiple of 2^-fraction that is not above value.
inline double floor_to(double value, int fraction) {
  return std::floor(value * power_of_two(fraction)) * power_of_two(-fraction);
}

/// Nearest multiple of 2^-fraction, the upper one of two equally near.
inline double round_to(double value, int fraction) {
  return std::floor(value * power_of_two(fraction) + 0.5) * power_of_two(-fraction);
}

/// round_to of the exact product a b, which may need more than 53 bits.
inline double round_product_to(double a, double b, int fraction) {
  const double scaled = a * power_of_two(fraction);
  const double product = scaled * b;
  const double lost = std::fma(scaled, b, -product);
  const double below = std::floor(product + 0.5);
  const double rest = product - below + 0.5 + lost;  // of the exact product; within one step of [0, 1)
  return (below + std::floor(rest)) * power_of_two(-fraction);
}

/// value modulo span, in [-span/2, span/2). Exact: a double minus a multiple of a power of two, nearer to
/// zero.
inline double modulo(double value, double span) {
  return value - span * std::floor(value / span + 0.5);
}

/// Number of values of a format times its step: the span of its words.
inline double span_of(const config::Format& format) {
  return power_of_two(format.width - format.fraction);
}
inline double lowest_of(const config::Format& format) {
  return -span_of(format) / 2;
}
inline double highest_of(const config::Format& format) {
  return span_of(format) / 2 - power_of_two(-format.fraction);
}

/// The quantisers of one precision: those of an ideal chain hand their argument through.
class Arithmetic {
 public:
  explicit Arithmetic(Precision precision) : quantised_(precision == Precision::quantised) {}

  bool quantised() const { return quantised_; }
  double round(double value, int fraction) const { return quantised_ ? round_to(value, fraction) : value; }
  double floor(double value, int fraction) const { return quantised_ ? floor_to(value, fraction) : value; }
  double round_product(double a, double b, int fraction) const {
    return quantised_ ? round_product_to(a, b, fraction) : a * b;
  }
  double wrap(double value, const config::Format& format) const {
    return quantised_ ? modulo(value, span_of(format)) : value;
  }
  /// Clips to the format's range; clipped is set where that changed the value and left alone otherwise.
  double saturate(double value, const config::Format& format, bool& clipped) const {
    if (!quantised_) return value;
    const double inside = std::clamp(value, lowest_of(format), highest_of(format));
    clipped = clipped || inside != value;
    return inside;
  }

 private:
  bool quantised_;
};

}  // namespace hemi::golden

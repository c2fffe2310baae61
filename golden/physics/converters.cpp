// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/converters.hpp"

#include <cmath>

namespace hemi::physics {

namespace {

constexpr int kSegments = 16;

struct Curve {
  std::array<double, kSegments> offset;  // at the lower end of each segment
  double slope;                          // over the whole range
};

// Relative errors of the weights of the bits 1/16, 1/8, 1/4 and 1/2 of the range: the larger capacitor errs
// more.
constexpr std::array<double, 4> kBitError{0.2, -0.3, 0.5, -1.0};

constexpr Curve make_curve() {
  Curve curve{};
  for (int segment = 0; segment < kSegments; ++segment) {
    for (int bit = 0; bit < 4; ++bit) curve.offset[segment] += (segment >> bit & 1) * kBitError[bit];
  }
  curve.slope = curve.offset[kSegments - 1];
  double peak = 0.0;
  for (int segment = 0; segment < kSegments; ++segment) {
    for (int end = 0; end < 2; ++end) {
      const double value = curve.offset[segment] - curve.slope * (segment + end) / kSegments;
      peak = std::max(peak, value < 0.0 ? -value : value);
    }
  }
  for (double& offset : curve.offset) offset /= peak;
  curve.slope /= peak;
  return curve;
}

}  // namespace

double integral_nonlinearity(double position) {
  static constexpr Curve kCurve = make_curve();
  const double inside = std::clamp(position, 0.0, 1.0);
  const int segment = std::min(static_cast<int>(inside * kSegments), kSegments - 1);
  return kCurve.offset[segment] - kCurve.slope * inside;
}

}  // namespace hemi::physics

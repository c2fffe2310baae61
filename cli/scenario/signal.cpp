// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hemi::scenario {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

}  // namespace

double Signal::line(double time_s) const {
  const auto next = std::ranges::upper_bound(points_, time_s, {}, &Point::time_s);
  if (next == points_.begin()) return next->value;
  const Point& before = *(next - 1);
  if (next == points_.end()) return before.value;
  return std::lerp(before.value, next->value, (time_s - before.time_s) / (next->time_s - before.time_s));
}

double Signal::value(double time_s) const {
  if (amplitude_ == 0.0) return line(time_s);
  return line(time_s) + amplitude_ * std::sin(kTwoPi * frequency_hz_ * time_s);
}

double Signal::slope(double time_s) const {
  double slope = 0.0;
  const auto next = std::ranges::upper_bound(points_, time_s, {}, &Point::time_s);
  if (next != points_.begin() && next != points_.end()) {
    const Point& before = *(next - 1);
    slope = (next->value - before.value) / (next->time_s - before.time_s);
  }
  if (amplitude_ == 0.0) return slope;
  const double omega_rad_s = kTwoPi * frequency_hz_;
  return slope + amplitude_ * omega_rad_s * std::cos(omega_rad_s * time_s);
}

std::pair<double, double> Signal::range(double end_s) const {
  double low = line(0.0), high = low;
  const auto include = [&](double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const Point& point : points_) {
    if (point.time_s >= 0.0 && point.time_s <= end_s) include(point.value);
  }
  include(line(end_s));
  return {low - std::abs(amplitude_), high + std::abs(amplitude_)};
}

}  // namespace hemi::scenario

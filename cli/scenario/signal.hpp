// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

namespace hemi::scenario {

/// An input over time: linear between breakpoints and constant beyond them, plus a sine.
///
///     value(t) = line(t) + amplitude sin(2 pi frequency t)
///
/// Two breakpoints at one time are a jump; at that time the later value holds.
class Signal {
 public:
  struct Point {
    double time_s;
    double value;
  };

  explicit Signal(double constant) : points_{{0.0, constant}} {}
  /// At least one point, times not decreasing.
  explicit Signal(std::vector<Point> points) : points_(std::move(points)) {}
  Signal(double offset, double amplitude, double frequency_hz)
      : points_{{0.0, offset}}, amplitude_(amplitude), frequency_hz_(frequency_hz) {}

  double value(double time_s) const;
  /// Time derivative; at a breakpoint that of the stretch that begins there.
  double slope(double time_s) const;
  /// Smallest and largest value from 0 to end_s (a sine counts with its whole swing).
  std::pair<double, double> range(double end_s) const;
  /// Of the last breakpoint.
  double end_s() const { return points_.back().time_s; }
  bool constant() const { return points_.size() == 1 && amplitude_ == 0.0; }

 private:
  double line(double time_s) const;

  std::vector<Point> points_;
  double amplitude_ = 0.0;
  double frequency_hz_ = 0.0;
};

}  // namespace hemi::scenario

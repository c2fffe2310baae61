// SPDX-License-Identifier: Apache-2.0
// What the tops are fed with: the regression's hostile capture and telemetry, as the engines' tests use them.
#ifndef HEMI_TESTS_HLS_TOPS_SIGNALS_HPP
#define HEMI_TESTS_HLS_TOPS_SIGNALS_HPP

#include <cmath>
#include <random>
#include <vector>

#include "tb/registers.hpp"
#include "tests/tb/signals.hpp"

namespace hemi::tests {

inline tb::RegisterImage top_registers() {
  return tb::to_image(busy_control(busy_registers(false, 4410.0)));
}

/// At least `pairs` sample pairs: tone and every hostile stretch, in proportion.
inline std::vector<tb::SamplePair> top_capture(std::size_t pairs) {
  return hostile_capture(false, pairs / 18 + 1, 17);
}

struct Telemetry {
  std::int64_t frequency, rate;
  bool valid;
};

/// A temperature that swings 15 Hz about the reference in 5000 outputs, a rate of 40 deg/h in noise; one
/// output in 997 out of range, one in 1999 not valid.
inline std::vector<Telemetry> top_telemetry(std::size_t outputs) {
  std::mt19937_64 generator(23);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<Telemetry> all;
  for (std::size_t i = 0; i < outputs; ++i) {
    const double swing = 15.0 * std::sin(2 * std::numbers::pi * static_cast<double>(i) / 5000.0);
    const double jump = i % 997 == 996 ? 500.0 * noise(generator) : 0.0;
    all.push_back(
        {tb::to_raw(4432.07 + swing + jump + 1e-4 * noise(generator), config::frequency, "frequency"),
         tb::to_raw(40.0 + 30.0 * noise(generator), config::rate, "rate"), i % 1999 != 1998});
  }
  return all;
}

}  // namespace hemi::tests

#endif  // HEMI_TESTS_HLS_TOPS_SIGNALS_HPP

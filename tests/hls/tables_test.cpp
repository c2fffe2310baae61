// SPDX-License-Identifier: Apache-2.0
#include "hls/tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hls/config.hpp"

namespace {

using namespace hemi;

std::int64_t nearest(double x) {
  return static_cast<std::int64_t>(std::floor(x + 0.5));
}

TEST(Tables, SineBaseAndDelta) {
  const auto line = [](int i) {
    return nearest(config::table_scale * std::sin(std::numbers::pi / 2 * i / 512));
  };
  for (int i = 0; i < 512; ++i) {
    EXPECT_EQ(hls::sine_base[i], line(i)) << i;
    EXPECT_EQ(hls::sine_delta[i], line(i + 1) - line(i)) << i;
    EXPECT_LT(hls::sine_delta[i], 1 << 12) << i;
  }
}

TEST(Tables, CordicAngles) {
  for (int i = 0; i < config::cordic_iterations; ++i) {
    EXPECT_EQ(hls::cordic_angle[i],
              nearest(std::atan(std::ldexp(1.0, -i)) / (2 * std::numbers::pi) * std::ldexp(1.0, 32)))
        << i;
  }
}

}  // namespace

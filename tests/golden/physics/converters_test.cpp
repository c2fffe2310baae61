// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/converters.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hemi::physics {
namespace {

TEST(Adc, RoundsHalfUp) {
  const Adc adc(16);
  for (int code = -32768; code < 32768; code += 77) {
    const double fraction = code / 32768.0;
    EXPECT_EQ(adc.convert(fraction, 0.0), code);
    EXPECT_EQ(adc.convert(fraction, 0.499), std::min(code, 32767));
    EXPECT_EQ(adc.convert(fraction, 0.5), std::min(code + 1, 32767));
    EXPECT_EQ(adc.convert(fraction, -0.5), code);
    EXPECT_EQ(adc.convert(fraction, -0.501), std::max(code - 1, -32768));
  }
}

TEST(Adc, HoldsAtTheRails) {
  for (const int bits : {16, 18}) {
    const Adc adc(bits);
    const std::int32_t top = (1 << (bits - 1)) - 1;
    EXPECT_EQ(adc.convert(1.0, 0.0), top);
    EXPECT_EQ(adc.convert(0.9999, 1e6), top);
    EXPECT_EQ(adc.convert(7.0, 3.0), top);
    EXPECT_EQ(adc.convert(-1.0, -0.6), -top - 1);
    EXPECT_EQ(adc.convert(-7.0, -1e6), -top - 1);
  }
}

TEST(Adc, ClipsInFrontOfOffsetAndNoise) {
  Adc adc(16);
  adc.set(5.0, 0.0, 0.5);
  EXPECT_EQ(adc.convert(0.7, 0.0), 16384 + 5);
  EXPECT_EQ(adc.convert(-0.7, 2.0), -16384 + 5 + 2);
  EXPECT_EQ(adc.convert(0.25, 0.0), 8192 + 5);
}

TEST(Adc, OffsetAndNonLinearityAreVoltsWhateverTheBits) {
  Adc adc(18);
  adc.set(-3.0, 0.0, 1.0);
  EXPECT_EQ(adc.convert(0.0, 0.0), -12);
  adc.set(0.0, 50.0, 1.0);
  Adc narrow(16);
  narrow.set(0.0, 50.0, 1.0);
  for (double fraction = -0.99; fraction < 0.99; fraction += 0.013) {
    EXPECT_NEAR(adc.convert(fraction, 0.0) / 4.0, narrow.convert(fraction, 0.0), 0.5 + 0.125);
  }
}

// An end-point curve: nothing at both ends, 1 at its largest, and steps only where one of the four upper bits
// changes.
TEST(Adc, NonLinearityIsBoundToItsCodes) {
  EXPECT_NEAR(integral_nonlinearity(0.0), 0.0, 1e-15);
  EXPECT_NEAR(integral_nonlinearity(1.0), 0.0, 1e-15);
  constexpr int kPoints = 1 << 16;
  double peak = 0.0;
  double sum_of_squares = 0.0;
  int steps = 0;
  for (int i = 0; i + 1 < kPoints; ++i) {
    const double here = integral_nonlinearity(static_cast<double>(i) / kPoints);
    const double next = integral_nonlinearity(static_cast<double>(i + 1) / kPoints);
    peak = std::max(peak, std::abs(here));
    sum_of_squares += here * here;
    if (std::abs(next - here) > 1e-3) {
      ++steps;
      EXPECT_EQ((i + 1) % (kPoints / 16), 0);
    }
  }
  EXPECT_NEAR(peak, 1.0, 1e-4);
  EXPECT_EQ(steps, 15);
  EXPECT_GT(sum_of_squares / kPoints, 0.05);
}

TEST(Dac, WordIsAFractionOfFullScale) {
  EXPECT_EQ(dac_fraction(-32768), -1.0);
  EXPECT_EQ(dac_fraction(16384), 0.5);
  EXPECT_EQ(dac_fraction(32767), 1.0 - 0x1p-15);
}

}  // namespace
}  // namespace hemi::physics

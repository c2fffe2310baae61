// SPDX-License-Identifier: Apache-2.0
// Corners that random runs of the chain rarely meet.
#include "golden/chain/arithmetic.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "golden/chain/reference_phase_loop.hpp"

namespace hemi::golden {
namespace {

TEST(Arithmetic, ProductsBeyond53BitsAreRoundedAsAWhole) {
  std::mt19937_64 random(3);
  int needed = 0;
  for (int trial = 0; trial < 1000000; ++trial) {
    const std::int64_t error = -static_cast<std::int64_t>(random() >> 33) - 1;
    const std::int64_t gain = -static_cast<std::int64_t>(random() >> 41) - 1;
    const std::int64_t expected = (error * gain + (1 << 13)) >> 14;  // of 2^-62 to 2^-48
    const double a = std::ldexp(static_cast<double>(error), -32);
    const double b = std::ldexp(static_cast<double>(gain), -30);
    ASSERT_EQ(std::ldexp(round_product_to(a, b, 48), 48), static_cast<double>(expected))
        << error << " * " << gain;
    needed += round_to(a * b, 48) != round_product_to(a, b, 48);
  }
  EXPECT_GT(needed, 0) << "no product of these told the two apart";
}

TEST(Arithmetic, HalvesGoUp) {
  EXPECT_EQ(round_to(0.5, 0), 1.0);
  EXPECT_EQ(round_to(-0.5, 0), 0.0);
  EXPECT_EQ(round_to(-1.5, 0), -1.0);
  EXPECT_EQ(round_to(-1.5 - 1e-9, 0), -2.0);
}

TEST(Arithmetic, SpansAreHalfOpen) {
  EXPECT_EQ(modulo(16.0, 32.0), -16.0);
  EXPECT_EQ(modulo(-16.0, 32.0), -16.0);
  EXPECT_EQ(modulo(-16.0 - power_of_two(-48), 32.0), 16.0 - power_of_two(-48));
}

TEST(ReferencePhaseLoop, LockWindowIsHalfOpen) {
  const double edge = 1.0 / 16.0;
  for (const auto& [phase_error, counts] :
       {std::pair{-edge, 1.0}, std::pair{edge, 0.0}, std::pair{edge - power_of_two(-32), 1.0},
        std::pair{-edge - power_of_two(-32), 0.0}}) {
    ReferencePhaseLoop loop(Precision::quantised, {0.0, 0.0, 0.0, 0.0, 0.0, 10.0});
    loop.tick({1.0, phase_error});
    EXPECT_EQ(loop.lock_counter(), counts) << phase_error;
  }
}

TEST(ReferencePhaseLoop, HoldsOverAndForgetsOnlyFourTicksForOne) {
  ReferencePhaseLoop loop(Precision::quantised, {0.0390625, 0.0, 0.0, 0.0, 0.5, 8.0});
  for (int tick = 0; tick < 8; ++tick) {
    EXPECT_FALSE(loop.locked());
    loop.tick({1.0, 0.0});
  }
  EXPECT_TRUE(loop.locked());
  loop.tick({0.25, 0.3});
  EXPECT_TRUE(loop.holdover());
  EXPECT_EQ(loop.lock_counter(), 8.0);
  EXPECT_EQ(loop.increment(), 0.0390625);
  loop.tick({1.0, 0.3});
  EXPECT_EQ(loop.lock_counter(), 4.0);
  EXPECT_TRUE(loop.locked());
  loop.tick({1.0, 0.3});
  EXPECT_FALSE(loop.locked());
}

}  // namespace
}  // namespace hemi::golden

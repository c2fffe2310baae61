// SPDX-License-Identifier: Apache-2.0
// phase_detector, reference_phase_loop and frequency_tracker against their equations.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "hls/frequency_tracker.hpp"
#include "hls/reference_phase_loop.hpp"

namespace {

using namespace hemi;
using namespace hemi::hls;

TEST(PhaseDetector, AngleAndMagnitudeEverywhere) {
  double gain = 1;
  for (int i = 0; i < 24; ++i) gain *= std::sqrt(1 + std::ldexp(1.0, -2 * i));
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi), radius(0.05, 0.6);
  for (int n = 0; n < 20000; ++n) {
    const double r = radius(generator), phi = angle(generator);
    const auto i = static_cast<std::int64_t>(std::ldexp(r * std::cos(phi), 27)),
               q = static_cast<std::int64_t>(std::ldexp(r * std::sin(phi), 27));
    const Polar polar = PhaseDetector::vectoring(from_raw<Baseband>(i), from_raw<Baseband>(q));
    const double expected =
        std::atan2(static_cast<double>(q), static_cast<double>(i)) / (2 * std::numbers::pi);
    const double error =
        std::remainder(std::ldexp(raw(polar.phase_error), -32) - expected, 1.0) * 2 * std::numbers::pi;
    // Last angle 2^-23 rad; 24 floors of at most one unit of 2^-32 on x or y of r K; 24 roundings of angles.
    EXPECT_LE(std::abs(error),
              std::ldexp(1.0, -23) + 24 * std::ldexp(1.0, -32) * (1 / (r * gain) + 2 * std::numbers::pi))
        << i << " " << q;
    const double amplitude =
        gain * std::ldexp(std::hypot(static_cast<double>(i), static_cast<double>(q)), -27);
    EXPECT_NEAR(std::ldexp(raw(polar.amplitude), -32), amplitude,
                24 * 2 * std::ldexp(1.0, -32) + amplitude * std::ldexp(1.0, -46));
  }
}

TEST(PhaseDetector, RotationClipsAndSaysSo) {
  bool saturated = false;
  const auto one = from_raw<RegisterWord<config::reg_demodulation_cos>>(1 << 22);
  const auto half_turn = from_raw<RegisterWord<config::reg_demodulation_cos>>(-(1 << 22));
  const auto none = from_raw<RegisterWord<config::reg_demodulation_sin>>(0);
  const Baseband low = from_raw<Baseband>(-(1 << 27)), some = from_raw<Baseband>(12345);
  Secondary s = PhaseDetector::rotate(low, some, one, none, saturated);
  EXPECT_EQ(raw(s.in_phase), -(1 << 27));
  EXPECT_EQ(raw(s.quadrature), 12345);
  EXPECT_FALSE(saturated);
  s = PhaseDetector::rotate(low, some, half_turn, none, saturated);
  EXPECT_EQ(raw(s.in_phase), (1 << 27) - 1);
  EXPECT_TRUE(saturated);
}

Registers loop_registers() {
  std::int64_t image[config::register_count] = {};
  image[config::reg_nco_start] = std::int64_t{12455000} << 20;
  image[config::reg_loop_proportional] = 1 << 20;
  image[config::reg_loop_integral] = 1 << 20;
  image[config::reg_loop_frequency] = 1 << 20;
  image[config::reg_amplitude_threshold] = 1000;
  image[config::reg_lock_count] = 10;
  Registers r;
  r.load(image);
  return r;
}

TEST(ReferencePhaseLoop, LocksHoldsOverAndLosesLock) {
  const Registers r = loop_registers();
  ReferencePhaseLoop loop;
  loop.reset(r.nco_start);
  bool saturated = false;
  const Polar still = {from_raw<CordicWord>(1000), from_raw<Angle>(0)};
  for (int k = 0; k < 9; ++k) loop.step(still, r, saturated);
  EXPECT_FALSE(loop.locked());
  loop.step(still, r, saturated);
  EXPECT_TRUE(loop.locked());
  const Increment before = loop.integral();
  const Polar lost = {from_raw<CordicWord>(999), from_raw<Angle>(1 << 30)};
  for (int k = 0; k < 100; ++k) loop.step(lost, r, saturated);
  EXPECT_TRUE(loop.holdover());
  EXPECT_TRUE(loop.locked());
  EXPECT_EQ(raw(loop.increment()), raw(before));
  const Polar off = {from_raw<CordicWord>(1000), from_raw<Angle>(1 << 28)};  // just outside the window
  for (int k = 0; k < 2; ++k) loop.step(off, r, saturated);
  EXPECT_TRUE(loop.locked());  // 10 - 4 - 4 = 2
  EXPECT_FALSE(loop.holdover());
  loop.step(off, r, saturated);
  EXPECT_FALSE(loop.locked());
  EXPECT_FALSE(saturated);
}

TEST(ReferencePhaseLoop, CorrectionsAreRoundedProducts) {
  const Registers r = loop_registers();
  ReferencePhaseLoop loop;
  loop.reset(r.nco_start);
  bool saturated = false;
  const std::int64_t e = 123456789;
  loop.step({from_raw<CordicWord>(1000), from_raw<Angle>(e)}, r, saturated);
  const auto rounded = [](std::int64_t product, int shift) {
    return (product + (std::int64_t{1} << (shift - 1))) >> shift;
  };
  // e has 32 fraction bits, the gains 30 and 40, the increment 48; not locked yet, so the frequency term
  // counts.
  const std::int64_t integral = raw(r.nco_start) + rounded(e << 20, 14) + rounded(e << 20, 24);
  EXPECT_EQ(raw(loop.integral()), integral);
  EXPECT_EQ(raw(loop.increment()), integral + rounded(e << 20, 14));
}

TEST(FrequencyTracker, SumOfOutputsIsThePhase) {
  // Any phases whatever: the outputs telescope to the difference of two means of 25 phases.
  FrequencyTracker tracker;
  tracker.reset();
  std::mt19937_64 generator(9);
  std::uniform_int_distribution<std::int64_t> jitter(-(std::int64_t{1} << 28), std::int64_t{1} << 28);
  const std::int64_t advance = (std::int64_t{885} << 48) / 1000;
  std::int64_t nco = 0, unwrapped = 0, last = 0, sum_outputs = 0, first_mean = 0, mean = 0;
  for (int m = 0; m < 40; ++m) {
    mean = 0;
    for (int i = 0; i < 25; ++i) {
      nco += advance;
      const Polar polar = {from_raw<CordicWord>(1), from_raw<Angle>(jitter(generator))};
      const std::int64_t phase = raw(tracker.step(from_raw<Phase>(nco), polar));
      // 37-bit words: the difference as the nearest one modulo 32 turns.
      unwrapped += ((phase - last) << 27) >> 27;
      last = phase;
      mean += unwrapped;
    }
    const std::int64_t frequency = raw(tracker.frequency());
    if (m == 1)
      first_mean = mean;  // the first interval holds the start of the delay line
    else if (m > 1)
      sum_outputs += frequency;
  }
  EXPECT_EQ(sum_outputs, mean - first_mean);
  // 38 intervals of 25 ticks, 25 phases a mean; jitter of up to 1/16 turn in each of two means.
  EXPECT_NEAR(std::ldexp(static_cast<double>(sum_outputs), -32), 0.885 * 25 * 25 * 38, 2 * 25 / 16.0);
}

}  // namespace

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/golden/diagnosis/telemetry_writer.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
constexpr double kAmplitude_dph = 0.1;
constexpr double kDeviations = 5.0;

class Lines : public testing::Test {
 protected:
  Telemetry telemetry_ = tests::telemetry({.seed = 4});
  Simulation simulation_ = simulate(telemetry_, tests::nominal());
  Eigen::VectorXd noise_ = telemetry_[Output::rate] - simulation_.nominal[Output::rate];

  std::optional<Line> in(const Eigen::VectorXd& residual) const {
    return find_line(telemetry_, simulation_, Output::rate, residual);
  }
};

TEST_F(Lines, NoiseHasNone) {
  EXPECT_FALSE(in(noise_));
}

// Amplitude and frequency of a line between two bins, in the deviations that they are stated with.
TEST_F(Lines, MeasuresAStandingLine) {
  const auto rows = static_cast<double>(noise_.size());
  for (const double between : {0.0, 0.25, 0.5}) {
    const double line_hz = (2466.0 + between) / rows;
    Eigen::VectorXd residual = noise_;
    for (Index i = 0; i < residual.size(); ++i)
      residual[i] += kAmplitude_dph * std::sin(2.0 * std::numbers::pi * line_hz * static_cast<double>(i));
    const auto line = in(residual);
    ASSERT_TRUE(line) << between;
    EXPECT_EQ(line->harmonic, 0);
    EXPECT_NEAR(line->amplitude, kAmplitude_dph, kDeviations * line->amplitude_deviation) << between;
    EXPECT_NEAR(line->frequency_hz, line_hz, kDeviations * line->frequency_deviation_hz) << between;
    // sqrt(24 sigma^2 / (A^2 N^3)) / 2 pi for white noise of sigma.
    const double sigma = std::sqrt(noise_.squaredNorm() / rows);
    const double least = std::sqrt(24.0 / rows) * sigma / (kAmplitude_dph * rows * 2.0 * std::numbers::pi);
    EXPECT_NEAR(line->frequency_deviation_hz, least, 0.3 * least);
  }
}

// A core samples the carrier at the start, in the middle or at the end of a row's interval.
TEST_F(Lines, FollowsTheResonatorHoweverItWasSampled) {
  for (const double within : {0.0, 0.5, 1.0}) {
    Eigen::VectorXd residual = noise_;
    double turns = 0.0;
    for (Index i = 0; i < residual.size(); ++i) {
      const double step = 2.0 * telemetry_[Output::frequency][i] * telemetry_.step_s;
      residual[i] +=
          kAmplitude_dph * std::sin(2.0 * std::numbers::pi * std::fmod(turns + within * step, 1.0));
      turns += step;
    }
    const auto line = in(residual);
    ASSERT_TRUE(line) << within;
    EXPECT_EQ(line->harmonic, 2);
    EXPECT_NEAR(line->amplitude, kAmplitude_dph, kDeviations * line->amplitude_deviation) << within;
    EXPECT_LT(line->low_hz, line->high_hz);
  }
}

// The phase that is summed up from recorded frequencies carries their noise: over a recording it wanders.
TEST_F(Lines, AWanderingPhaseTakesNothingOffTheAmplitude) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> step(0.0, 2.5 / std::sqrt(static_cast<double>(noise_.size())));
  Eigen::VectorXd residual = noise_;
  double turns = 0.0, wander_rad = 0.0;
  for (Index i = 0; i < residual.size(); ++i) {
    residual[i] += kAmplitude_dph * std::sin(2.0 * std::numbers::pi * std::fmod(turns, 1.0) + wander_rad);
    turns += telemetry_[Output::frequency][i] * telemetry_.step_s;
    wander_rad += step(random);
  }
  const auto line = in(residual);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->harmonic, 1);
  EXPECT_NEAR(line->amplitude, kAmplitude_dph, 3.0 * line->amplitude_deviation);
  EXPECT_LT(line->amplitude_deviation, 0.1 * kAmplitude_dph);
}

}  // namespace
}  // namespace hemi::diagnosis

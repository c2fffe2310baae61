// SPDX-License-Identifier: Apache-2.0
// Faults of the electronics behind the core: what they do to finished telemetry.
#include "tests/golden/physics/effects_support.hpp"

namespace hemi::physics {
namespace {

/// Telemetry in which every channel is another straight line.
std::vector<TelemetrySample> lines(double interval_s, std::size_t count, double frequency_hz,
                                   double slope_hz_s) {
  std::vector<TelemetrySample> telemetry(count);
  for (std::size_t i = 0; i < count; ++i) {
    TelemetrySample& sample = telemetry[i];
    const double t = interval_s * static_cast<double>(i);
    sample.time_s = t;
    sample.frequency_hz = frequency_hz + slope_hz_s * t;
    sample.amplitude = 1.0 + 1e-6 * t;
    sample.drive_v = 2.0 + 1e-4 * t;
    sample.quadrature_v = 0.5 + 2e-4 * t;
    sample.rate_dph = 3.0 + 0.01 * t;
  }
  return telemetry;
}

std::vector<TelemetrySample> distorted(const ActiveEffect& effect, std::vector<TelemetrySample> telemetry,
                                       std::uint64_t seed = 3) {
  World world(Instrument{}, {effect}, Environment{}, seed);
  world.distort(telemetry);
  return telemetry;
}

/// All channels but the one are equal in every digit.
void expect_only(const std::string& touched, const std::vector<TelemetrySample>& a,
                 const std::vector<TelemetrySample>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, channel] : measured_channels()) {
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) different += a[i].*channel != b[i].*channel;
    if (name == touched) {
      EXPECT_GT(different, 0U) << name;
    } else {
      EXPECT_EQ(different, 0U) << name;
    }
  }
}

TEST(FaultSignature, ReferencePhaseLoopLagsARamp) {
  const auto before = lines(0.5, 200, 4425.0, 0.01);
  const auto after = distorted({"pll_lag", {{"time_constant", 3.0}}}, before);
  expect_only("frequency_hz", before, after);
  for (const TelemetrySample& sample : after) {
    const double t = sample.time_s;
    EXPECT_NEAR(sample.frequency_hz, 4425.0 + 0.01 * (t - 3.0 * (1.0 - std::exp(-t / 3.0))), 1e-11);
  }
}

TEST(FaultSignature, CycleSlipsArePulsesOfOneTurn) {
  const auto before = lines(0.1, 1000, 4425.0, 0.001);
  const auto after = distorted({"cycle_slip", {{"count", 7.0}}}, before);
  expect_only("frequency_hz", before, after);
  int slips = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double turns = (after[i].frequency_hz - before[i].frequency_hz) * 0.1;
    if (turns == 0.0) continue;
    EXPECT_NEAR(std::abs(turns), 1.0, 1e-11);
    ++slips;
  }
  EXPECT_EQ(slips, 7);
}

TEST(FaultSignature, LostSamplesRepeatTheOneBefore) {
  const auto before = lines(1.0, 500, 4425.0, 0.001);
  const auto after = distorted({"sample_loss", {{"count", 9.0}}}, before);
  ASSERT_EQ(after.size(), before.size());
  int repeated = 0;
  for (std::size_t i = 1; i < after.size(); ++i) {
    EXPECT_EQ(after[i].time_s, before[i].time_s);
    const bool same = after[i].rate_dph == after[i - 1].rate_dph;
    repeated += same;
    for (const Channel channel :
         {&TelemetrySample::frequency_hz, &TelemetrySample::amplitude, &TelemetrySample::drive_v,
          &TelemetrySample::quadrature_v, &TelemetrySample::rate_dph}) {
      EXPECT_EQ(after[i].*channel, (same ? after[i - 1] : before[i]).*channel);
    }
  }
  EXPECT_EQ(repeated, 9);
}

TEST(FaultSignature, DroppedSamplesLeaveGapsInTime) {
  const auto before = lines(1.0, 500, 4425.0, 0.001);
  const auto after = distorted({"sample_loss", {{"count", 9.0}, {"dropped", 1.0}}}, before);
  EXPECT_EQ(after.size(), before.size() - 9);
  for (const TelemetrySample& sample : after) {
    EXPECT_EQ(sample.rate_dph, before[static_cast<std::size_t>(std::lround(sample.time_s))].rate_dph);
  }
}

TEST(FaultSignature, TimeShiftDelaysOneChannel) {
  const auto before = lines(1.0, 300, 4425.0, 0.02);
  const auto late = distorted({"time_shift", {{"delay", 2.5}}}, before);
  expect_only("rate_dph", before, late);
  for (std::size_t i = 3; i < late.size(); ++i)
    EXPECT_NEAR(late[i].rate_dph, before[i].rate_dph - 0.01 * 2.5, 1e-12);
  const auto frequency = distorted({"time_shift", {{"delay", 2.5}, {"channel", 1.0}}}, before);
  expect_only("frequency_hz", before, frequency);
  for (std::size_t i = 3; i < late.size(); ++i) {
    EXPECT_NEAR(frequency[i].frequency_hz, before[i].frequency_hz - 0.02 * 2.5, 1e-11);
  }
}

TEST(FaultSignature, InterferenceIsALineThatStays) {
  const auto before = lines(0.1, 2000, 4425.0, 0.05);
  const auto after =
      distorted({"interference", {{"amplitude", 0.7}, {"frequency", 1.3}, {"phase", 0.4}}}, before);
  expect_only("rate_dph", before, after);
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_NEAR(after[i].rate_dph - before[i].rate_dph,
                0.7 * std::sin(2.0 * std::numbers::pi * 1.3 * before[i].time_s + 0.4), 1e-12);
  }
  expect_only(
      "frequency_hz", before,
      distorted({"interference", {{"amplitude", 1e-5}, {"frequency", 1.3}, {"channel", 1.0}}}, before));
}

struct Folding {
  double multiple;
  double carrier_hz;
  double line_hz;  ///< negative: it falls when the carrier rises
};

TEST(FaultSignature, AliasedCarrierFoldsAt200HzAndMovesWithTheFrequency) {
  for (const Folding& f :
       {Folding{1.0, 4425.0, 25.0}, Folding{2.0, 4425.0, 50.0}, Folding{1.0, 4375.0, -25.0}}) {
    SCOPED_TRACE(f.carrier_hz * f.multiple);
    constexpr double kSlope = 0.3;
    const auto before = lines(0.005, 2000, f.carrier_hz, kSlope);
    const auto after = distorted({"aliased_carrier", {{"amplitude", 0.2}, {"multiple", f.multiple}}}, before);
    expect_only("rate_dph", before, after);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const double t = before[i].time_s;
      // the phase of the carrier itself, sampled at 200 Hz: whole turns are lost between samples
      const double turns = f.multiple * (f.carrier_hz * t + 0.5 * kSlope * t * t);
      // 4e4 turns in doubles, and as many sums
      EXPECT_NEAR(after[i].rate_dph - before[i].rate_dph,
                  0.2 * std::sin(2.0 * std::numbers::pi * std::remainder(turns, 1.0)), 1e-8);
    }
  }
  const auto before = lines(0.005, 400, 4425.0, 0.0);
  const auto given = distorted({"aliased_carrier", {{"amplitude", 0.2}, {"frequency", 31.0}}}, before);
  for (std::size_t i = 0; i < given.size(); ++i) {
    EXPECT_NEAR(given[i].rate_dph - before[i].rate_dph,
                0.2 * std::sin(2.0 * std::numbers::pi * 31.0 * before[i].time_s), 1e-9);
  }
}

}  // namespace
}  // namespace hemi::physics

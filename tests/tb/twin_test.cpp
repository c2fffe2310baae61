// SPDX-License-Identifier: Apache-2.0
// Slow twin against the plant at the ADC's rate with the core around it: the same scenario of transients,
// telemetry at 2 Hz.
#include <gtest/gtest.h>

#include "golden/physics/slow_twin.hpp"
#include "tb/hls_engine.hpp"
#include "tests/tb/control_bench.hpp"

namespace {

using namespace hemi;

constexpr double kInterval_s = 0.5;
constexpr int kSamples = 160;
constexpr double kSettle_s = 20.0;

/// Thermal time constants shortened, slopes enlarged, so that eighty seconds hold every transient.
physics::Instrument lively() {
  physics::Instrument instrument;
  instrument.case_time_constant_s = 4.0;
  instrument.shell_time_constant_s = 12.0;
  instrument.relative_damping = {1.0, 0.02};
  instrument.relative_split = {1.0, 0.05};
  instrument.force_noise_dph_rthz = 0.0;
  instrument.board_time_constant_s = 1.0;
  return instrument;
}

/// The chamber falls by 10 degC within 10 s.
physics::Environment cooling(double t) {
  physics::Environment e;
  e.time_s = t;
  e.chamber_degc = 20.0 - std::clamp(t - 5.0, 0.0, 10.0);
  e.power_on_s = -1e6;
  return e;
}

/// The table turns at 30 deg/s from 30 s to 45 s, at room temperature.
physics::Environment turning(double t) {
  physics::Environment e;
  e.time_s = t;
  e.rate_dph = t >= 30.0 && t < 45.0 ? 30.0 * 3600.0 : 0.0;
  e.power_on_s = -1e6;
  return e;
}

struct Channel {
  const char* name;
  std::function<double(const physics::TelemetrySample&)> twin;
  std::function<double(const tests::Reading&)> full;
};

void expect_agreement(physics::Environment (*inputs)(double), const std::vector<Channel>& channels) {
  const physics::Instrument instrument = lively();
  const auto start = inputs(-kSettle_s);
  auto world = std::make_shared<physics::World>(instrument, std::vector<physics::ActiveEffect>{}, start, 1);
  tests::ControlBench bench(tb::make_hls_engine(false), instrument, false, {1.0, 1.0, 0.0, 0.0}, 3,
                            physics::follow(world, [&](double t) { return inputs(t - kSettle_s); }));
  bench.run(kSettle_s);
  const auto records = bench.run(kSamples * kInterval_s + 0.1);
  physics::SlowTwinOptions options;
  options.noise = false;
  const auto telemetry = physics::simulate_slow(
      instrument, {}, physics::sample_inputs(inputs, 0.5 * kInterval_s, kInterval_s, kSamples), options);

  // A record describes the time 29 ticks less one sample before it is complete: 5.8 ms, one record and 0.8
  // ms.
  const std::size_t each = static_cast<std::size_t>(kInterval_s * config::output_rate_hz);
  for (const auto& channel : channels) {
    double low = 1e300, high = -1e300, worst = 0.0;
    int worst_at = 0;
    for (int i = 0; i < kSamples; ++i) {
      double mean = 0.0;
      for (std::size_t j = 0; j < each; ++j)
        mean += channel.full(records[static_cast<std::size_t>(i) * each + j + 1]);
      mean /= static_cast<double>(each);
      const double twin = channel.twin(telemetry[static_cast<std::size_t>(i)]);
      low = std::min(low, twin);
      high = std::max(high, twin);
      if (std::abs(mean - twin) > worst) {
        worst = std::abs(mean - twin);
        worst_at = i;
      }
    }
    std::printf("%-13s transient %.6g, worst difference %.3g (%.3f %%) at %.1f s\n", channel.name, high - low,
                worst, 100.0 * worst / (high - low), kInterval_s * (worst_at + 0.5));
    EXPECT_LE(worst, 0.01 * (high - low)) << channel.name;
  }
}

TEST(SlowTwin, AgreesWithTheFullPlantWithinOnePercentOfThermalTransients) {
  const physics::Instrument instrument = lively();
  const double hold_gain = loops::design_control(instrument, tests::sampling(false)).hold_gain;
  expect_agreement(cooling,
                   {{"frequency_hz", [](const auto& s) { return s.frequency_hz; },
                     [](const auto& r) { return r.frequency_hz; }},
                    {"drive_v", [](const auto& s) { return s.drive_v; },
                     [&](const auto& r) { return r.drive * instrument.drive_full_scale_v * hold_gain; }},
                    {"quadrature_v", [](const auto& s) { return s.quadrature_v; },
                     [&](const auto& r) { return -r.quadrature * instrument.quadrature_full_scale_v; }}});
}

TEST(SlowTwin, AgreesWithTheFullPlantWithinOnePercentOfARateStep) {
  expect_agreement(turning, {{"rate_dph", [](const auto& s) { return s.rate_dph; },
                              [](const auto& r) { return r.rate_dph; }}});
}

}  // namespace

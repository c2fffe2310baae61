// SPDX-License-Identifier: Apache-2.0
// Acquisition, cold start, and loss of the signal, with the plant around the hls engine.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tb/hls_engine.hpp"
#include "tests/tb/acquisition.hpp"

namespace {

using namespace hemi;

TEST(StartUp, AcquiresAnyRingingResonatorWithinTenSeconds) {
  tests::acquire(40, 11);
}

TEST(StartUp, ColdStartTakesTheTimeThatDriveAndQualityFactorSay) {
  // From rest the drive pumps at its limit: A = D k tau (1 - exp(-t/tau)), k: growth at full drive; the last
  // part, where the proportional loop lets the drive off its limit, is exponential with kp k.
  const physics::Instrument instrument;
  const auto nominal = instrument.at(20.0);
  const loops::ControlWishes wishes;
  const auto design = loops::design_control(instrument, loops::CoreSampling::reference(), wishes);
  const double pump_per_s = wishes.command_limit * nominal.drive_per_s;
  const double kp =
      design.amplitude.gains.proportional * design.amplitude_word;  // command per nominal amplitude
  const double leaves_limit = 1.0 - (wishes.command_limit - 1.0 / 400.0) / kp;
  const double tau_s = 1.0 / nominal.damping_per_s;
  const double to_limit_s = -tau_s * std::log(1.0 - leaves_limit / (pump_per_s * tau_s));
  const double to_close_s =
      std::log((1.0 - leaves_limit) / (1.0 - wishes.close_at)) / (kp * nominal.drive_per_s);
  const double predicted_s = to_limit_s + to_close_s;
  for (const double offset_hz : {0.0, 47.0, -60.0}) {
    physics::Parameters p = nominal;
    p.omega_rad_s += 2 * std::numbers::pi * offset_hz;
    auto source = [p](double, double) { return p; };
    tests::ControlBench bench(tb::make_hls_engine(false), instrument, false, {}, 3, source);
    const auto readings = bench.run(10.0);
    std::size_t first = 0;
    while (first < readings.size() && (tests::raised(readings[first], config::status_starting) ||
                                       tests::raised(readings[first], config::status_unlocked)))
      ++first;
    const double measured_s = static_cast<double>(first) / config::output_rate_hz;
    std::printf("cold start at %+.0f Hz: %.3f s, predicted %.3f s\n", offset_hz, measured_s, predicted_s);
    EXPECT_NEAR(measured_s, predicted_s, 0.2 * predicted_s);
    EXPECT_EQ(readings.back().live, 0u);
  }
}

TEST(StartUp, HoldsOverWhileTheSignalIsLostAndGoesOn) {
  const physics::Instrument instrument;
  double rate_dps = 20.0;
  tests::ControlBench bench(tb::make_hls_engine(false), instrument, false, {1.0, 1.0, 0.0, 0.0}, 9,
                            tests::turning(instrument, rate_dps));
  bench.run(15.0);
  for (const double lost_s : {1e-3, 3e-3, 0.01, 0.1, 1.0}) {
    const auto lost = bench.run(lost_s, [](tb::SamplePair& pair) { pair.x = pair.y = 0; });
    const auto after = bench.run(4.0);
    int held = 0;
    for (const auto* part : {&lost, &after}) {
      for (const auto& r : *part) {
        held += tests::raised(r, config::status_holdover) ? 1 : 0;
        EXPECT_FALSE(tests::raised(r, config::status_unlocked)) << lost_s;
        EXPECT_FALSE(tests::raised(r, config::status_searching)) << lost_s;
      }
    }
    // The front end remembers 0.9 ms: only a longer loss empties it and is seen as one.
    if (lost_s > 2e-3) {
      EXPECT_GE(held, std::max(1, static_cast<int>(lost_s * config::output_rate_hz) - 1)) << lost_s;
    }
    // Back within the loop's own settling: rate within 1 deg/s in 0.5 s, everything within 4 s.
    for (std::size_t i = 100; i < after.size(); ++i) {
      EXPECT_NEAR(after[i].rate_dph / 3600.0, rate_dps, 1.0) << lost_s << " " << i;
      EXPECT_NEAR(after[i].amplitude, 1.0, 5e-3) << lost_s;
    }
    EXPECT_EQ(after.back().live, 0u) << lost_s;
  }
}

TEST(StartUp, SearchesAgainWhenTheSignalStaysAway) {
  const physics::Instrument instrument;
  loops::ControlWishes wishes;
  wishes.longest_holdover_s = 0.5;
  tests::ControlBench bench(tb::make_hls_engine(false), instrument, false, {1.0, 1.0, 0.0, 0.0}, 9, {},
                            wishes);
  bench.run(5.0);
  const auto lost = bench.run(1.0, [](tb::SamplePair& pair) { pair.x = pair.y = 0; });
  EXPECT_TRUE(tests::raised(lost.back(), config::status_searching));
  EXPECT_TRUE(tests::raised(lost.back(), config::status_unlocked));
  EXPECT_FALSE(tests::raised(lost[80], config::status_searching));
  const auto after = bench.run(15.0);
  EXPECT_EQ(after.back().live, 0u);
}

}  // namespace

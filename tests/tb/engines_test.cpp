// SPDX-License-Identifier: Apache-2.0
// Quantised golden model = hls, word by word, in every block; ideal model close to both; the scoreboard
// itself.
#include <gtest/gtest.h>

#include "tb/golden_engine.hpp"
#include "tb/hls_engine.hpp"
#include "tb/sc_fixed_chain.hpp"
#include "tb/scoreboard.hpp"
#include "tests/tb/signals.hpp"

namespace {

using namespace hemi;

int decimation(bool wide) {
  return wide ? config::Wide::decimation : config::Reference::decimation;
}

class Engines : public testing::TestWithParam<bool> {};

void compare_over_hostile_capture(bool wide, const tb::RegisterValues& values,
                                  std::initializer_list<config::StatusBit> reached) {
  const auto pairs = tests::hostile_capture(wide, 45000, 17);
  ASSERT_GE(pairs.size(), 500000u);
  const auto golden = tb::make_golden_engine(wide, golden::Precision::quantised);
  const auto hls = tb::make_hls_engine(wide);
  tb::Scoreboard scoreboard(decimation(wide));
  for (auto* engine : {golden.get(), hls.get()}) engine->reset(values);
  golden->set_taps(&scoreboard.first());
  hls->set_taps(&scoreboard.second());
  std::vector<tb::Record> a, b;
  // Chunks of odd sizes: no engine may depend on where a call ends.
  for (std::size_t at = 0, n = 1; at < pairs.size(); at += n, n = n % 7919 + 613) {
    const std::span chunk(pairs.data() + at, std::min(n, pairs.size() - at));
    golden->samples(chunk, a);
    hls->samples(chunk, b);
    scoreboard.compare();
  }
  scoreboard.finish();
  ASSERT_FALSE(scoreboard.mismatch()) << scoreboard.mismatch()->report("golden", "hls");
  ASSERT_EQ(a.size(), pairs.size() / static_cast<std::size_t>(decimation(wide) * config::ticks_per_output));
  EXPECT_EQ(a, b);
  std::uint64_t seen = 0;
  for (const auto& record : a) seen |= static_cast<std::uint64_t>(record.words[config::word_status]);
  // The stimulus must have reached what it is meant to reach.
  for (const auto bit : reached) EXPECT_TRUE((seen >> bit) & 1) << config::status_names[bit];
}

TEST_P(Engines, GoldenEqualsHlsOverHalfAMillionPairsAndEveryHostileStretch) {
  const bool wide = GetParam();
  compare_over_hostile_capture(
      wide, tests::busy_registers(wide, 4410.0),
      {config::status_unlocked, config::status_holdover, config::status_adc_overload,
       config::status_sample_gap, config::status_out_of_calibrated_range, config::status_derivative_invalid});
}

TEST_P(Engines, GoldenEqualsHlsWithTheActuatorLoopsOnTheSameCapture) {
  const bool wide = GetParam();
  compare_over_hostile_capture(wide, tests::busy_control(tests::busy_registers(wide, 4410.0)),
                               {config::status_drive_saturated, config::status_quadrature_saturated,
                                config::status_rebalance_saturated, config::status_searching,
                                config::status_starting, config::status_holdover});
}

TEST_P(Engines, TelemetryAtRailsAndInvalidRows) {
  const bool wide = GetParam();
  const auto golden = tb::make_golden_engine(wide, golden::Precision::quantised);
  const auto hls = tb::make_hls_engine(wide);
  auto values = tests::busy_registers(wide, 4410.0);
  // Coefficients at their rails, so that every clip is reached.
  values[config::reg_bias_f3] = 262143.0;
  values[config::reg_bias_df2] = -262144.0;
  values[config::reg_thermometer_4] = 4095.0;
  values[config::reg_slope_shift] = 0;
  for (auto* engine : {golden.get(), hls.get()}) engine->reset(values);
  std::mt19937_64 generator(23);
  std::uniform_real_distribution<double> wander(-100.0, 100.0), rate(-500000.0, 500000.0);
  std::vector<tb::Record> a, b;
  double f = 4432.0;
  for (int i = 0; i < 20000; ++i) {
    f = i % 1000 < 800 ? f + 1e-4 * wander(generator) : 4432.0 + wander(generator);
    const bool valid = i % 613 != 0;
    const double r = i % 7 == 0 ? 524287.9 : rate(generator);
    golden->telemetry(f, r, valid, a);
    hls->telemetry(f, r, valid, b);
  }
  EXPECT_EQ(a, b);
  std::uint64_t seen = 0;
  for (const auto& record : a) seen |= static_cast<std::uint64_t>(record.words[config::word_status]);
  for (const auto bit : {config::status_frequency_out_of_range, config::status_thermometer_saturated,
                         config::status_derivative_saturated, config::status_bias_saturated,
                         config::status_compensation_saturated, config::status_frequency_invalid}) {
    EXPECT_TRUE((seen >> bit) & 1) << config::status_names[bit];
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Engines, testing::Bool(),
                         [](const auto& param_info) { return param_info.param ? "Wide" : "Reference"; });

TEST(ScFixed, TheCoreOnSystemCsTypeGivesTheSameRecords) {
  const auto pairs = [] {
    std::mt19937_64 generator(29);
    std::vector<tb::SamplePair> p;
    tests::append(p, tests::Stretch::tone, 15000, false, 4425.0, 3.0, generator);
    return p;
  }();
  const auto own = tb::make_hls_engine(false);
  const auto sc = tb::make_sc_fixed_engine();
  std::vector<tb::Record> a, b;
  for (auto* engine : {own.get(), sc.get()}) engine->reset(tests::busy_registers(false, 4410.0));
  own->samples(pairs, a);
  sc->samples(pairs, b);
  ASSERT_EQ(a.size(), 30u);
  EXPECT_EQ(a, b);
}

TEST(Scoreboard, NamesTheFirstSampleAndTheEarliestBlock) {
  tb::Scoreboard scoreboard(20);
  // Tick 2 (sample 59) differs late in the chain; sample 47 differs in the demodulator; and later in the nco
  // as well.
  for (int n = 0; n < 100; ++n) {
    scoreboard.first().tap(config::tap_cos, n);
    scoreboard.second().tap(config::tap_cos, n == 47 || n == 60 ? -1 : n);
    scoreboard.first().tap(config::tap_product_xi, n);
    scoreboard.second().tap(config::tap_product_xi, n == 47 ? 5 : n);
  }
  for (int k = 0; k < 5; ++k) {
    scoreboard.first().tap(config::tap_amplitude, k);
    scoreboard.second().tap(config::tap_amplitude, k == 1 ? 99 : k);
  }
  scoreboard.compare();
  ASSERT_TRUE(scoreboard.mismatch());
  // Tick 1 closes after sample 39, before sample 47.
  EXPECT_EQ(scoreboard.mismatch()->sample, 39u);
  EXPECT_EQ(scoreboard.mismatch()->tap, config::tap_amplitude);
  EXPECT_EQ(scoreboard.mismatch()->state[config::tap_cos], 38);
  EXPECT_EQ(scoreboard.mismatch()->state[config::tap_amplitude], 0);
}

TEST(Scoreboard, AWordThatOnlyOneSideSendsIsADifference) {
  tb::Scoreboard scoreboard(20);
  scoreboard.first().tap(config::tap_cos, 1);
  scoreboard.compare();
  EXPECT_FALSE(scoreboard.mismatch());
  scoreboard.finish();
  ASSERT_TRUE(scoreboard.mismatch());
  EXPECT_FALSE(scoreboard.mismatch()->second);
}

}  // namespace

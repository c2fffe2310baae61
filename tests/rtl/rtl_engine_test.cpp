// SPDX-License-Identifier: Apache-2.0
// The RTL against the fixed-point core, word by word in every block, under gaps, back-pressure and reset.
#include <gtest/gtest.h>

#include "tb/hls_engine.hpp"
#include "tb/scoreboard.hpp"
#include "tb/verilator_engine.hpp"
#include "tests/rtl/bits.hpp"
#include "tests/rtl/stand_in_plant.hpp"
#include "tests/tb/signals.hpp"

namespace {

using namespace hemi;
using tests::bits_seen;
using tests::decimation;
using tests::expect_bits;

/// Feeds both engines in chunks of odd sizes; fails at the first word that differs.
void expect_equal(bool wide, tb::Engine& rtl, tb::Engine& hls, const std::vector<tb::SamplePair>& pairs,
                  std::vector<tb::Record>& records) {
  tb::Scoreboard scoreboard(decimation(wide));
  hls.set_taps(&scoreboard.first());
  rtl.set_taps(&scoreboard.second());
  std::vector<tb::Record> expected;
  for (std::size_t at = 0, n = 1; at < pairs.size(); at += n, n = n % 7919 + 613) {
    const std::span chunk(pairs.data() + at, std::min(n, pairs.size() - at));
    hls.samples(chunk, expected);
    rtl.samples(chunk, records);
    scoreboard.compare();
    if (scoreboard.mismatch()) break;
  }
  scoreboard.finish();
  hls.set_taps(nullptr);
  rtl.set_taps(nullptr);
  ASSERT_FALSE(scoreboard.mismatch()) << scoreboard.mismatch()->report("hls", "rtl");
  ASSERT_EQ(records.size(),
            pairs.size() / static_cast<std::size_t>(decimation(wide) * config::ticks_per_output));
  ASSERT_EQ(records, expected);
}

class RtlEngine : public testing::TestWithParam<bool> {
 protected:
  bool wide() const { return GetParam(); }
};

TEST_P(RtlEngine, EqualsHlsOverEveryHostileStretch) {
  const auto rtl = tb::make_rtl_engine(wide());
  const auto hls = tb::make_hls_engine(wide());
  for (tb::Engine* engine : {rtl.get(), hls.get()}) engine->reset(tests::busy_registers(wide(), 4410.0));
  std::vector<tb::Record> records;
  expect_equal(wide(), *rtl, *hls, tests::hostile_capture(wide(), 45000, 17), records);
  std::uint64_t seen = 0;
  for (const tb::Record& record : records)
    seen |= static_cast<std::uint64_t>(record.words[config::word_status]);
  for (const auto bit : {config::status_unlocked, config::status_holdover, config::status_adc_overload,
                         config::status_sample_gap, config::status_out_of_calibrated_range,
                         config::status_derivative_invalid}) {
    EXPECT_TRUE((seen >> bit) & 1) << config::status_names[bit];
  }
}

TEST_P(RtlEngine, EqualsHlsWithTheActuatorLoopsOnTheHostileCapture) {
  const auto rtl = tb::make_rtl_engine(wide());
  const auto hls = tb::make_hls_engine(wide());
  const auto values = tests::busy_control(tests::busy_registers(wide(), 4410.0));
  for (tb::Engine* engine : {rtl.get(), hls.get()}) engine->reset(values);
  std::vector<tb::Record> records;
  expect_equal(wide(), *rtl, *hls, tests::hostile_capture(wide(), wide() ? 30000 : 12000, 19), records);
  expect_bits(bits_seen(records), {config::status_drive_saturated, config::status_quadrature_saturated,
                                   config::status_rebalance_saturated, config::status_searching,
                                   config::status_starting, config::status_holdover});
}

TEST_P(RtlEngine, DoesNotDependOnGapsBackPressureOrClocks) {
  const auto pairs = tests::hostile_capture(wide(), 4000, 5);
  const double heavy = 0.97;
  const tb::RtlOptions conditions[] = {
      {.seed = 3, .input_gap_probability = 0.99, .checks = true},
      {.seed = 4, .back_pressure_probability = heavy, .checks = true},
      {.seed = 5, .input_gap_probability = 0.9, .back_pressure_probability = 0.999},
      {.clocks_per_sample = 120, .checks = true}};
  for (const tb::RtlOptions& options : conditions) {
    const auto rtl = tb::make_rtl_engine(wide(), options);
    const auto hls = tb::make_hls_engine(wide());
    for (tb::Engine* engine : {rtl.get(), hls.get()}) engine->reset(tests::busy_registers(wide(), 4410.0));
    std::vector<tb::Record> records;
    expect_equal(wide(), *rtl, *hls, pairs, records);
    if (HasFatalFailure()) return;
  }
}

TEST_P(RtlEngine, TelemetryAtRailsAndInvalidRows) {
  const auto rtl = tb::make_rtl_engine(wide(), {.back_pressure_probability = 0.5, .checks = true});
  const auto hls = tb::make_hls_engine(wide());
  auto values = tests::busy_registers(wide(), 4410.0);
  values[config::reg_bias_f3] = 262143.0;
  values[config::reg_bias_df2] = -262144.0;
  values[config::reg_thermometer_4] = 4095.0;
  values[config::reg_slope_shift] = 0;
  tb::Scoreboard scoreboard(0);
  for (tb::Engine* engine : {rtl.get(), hls.get()}) engine->reset(values);
  hls->set_taps(&scoreboard.first());
  rtl->set_taps(&scoreboard.second());
  std::mt19937_64 generator(23);
  std::uniform_real_distribution<double> wander(-100.0, 100.0), rate(-500000.0, 500000.0);
  std::vector<tb::Record> a, b;
  double f = 4432.0;
  for (int i = 0; i < 5000; ++i) {
    f = i % 1000 < 800 ? f + 1e-4 * wander(generator) : 4432.0 + wander(generator);
    const bool valid = i % 613 != 0;
    const double r = i % 7 == 0 ? 524287.9 : rate(generator);
    hls->telemetry(f, r, valid, a);
    rtl->telemetry(f, r, valid, b);
  }
  scoreboard.finish();
  ASSERT_FALSE(scoreboard.mismatch()) << scoreboard.mismatch()->report("hls", "rtl");
  EXPECT_EQ(a, b);
  std::uint64_t seen = 0;
  for (const tb::Record& record : b) seen |= static_cast<std::uint64_t>(record.words[config::word_status]);
  for (const auto bit : {config::status_frequency_out_of_range, config::status_thermometer_saturated,
                         config::status_derivative_saturated, config::status_bias_saturated,
                         config::status_compensation_saturated, config::status_frequency_invalid}) {
    EXPECT_TRUE((seen >> bit) & 1) << config::status_names[bit];
  }
}

TEST_P(RtlEngine, RandomRegisters) {
  std::mt19937_64 generator(41);
  for (int round = 0; round < 12; ++round) {
    auto values = tests::busy_registers(wide(), 4425.0);
    for (int i = 0; i < config::register_count; ++i) {
      if (i == config::reg_log2_block || i == config::reg_slope_shift || i == config::reg_parity) continue;
      if (round % 3 == 0 && i <= config::reg_lock_count) continue;  // a third of the rounds can lock
      if (round % 2 == 0 && i == config::reg_control) continue;     // the other half may be closed loop
      const config::Format format = config::registers[i].format;
      const double limit = std::ldexp(1.0, format.width - 1 - format.fraction);
      values[i] = std::uniform_real_distribution<double>(-0.999 * limit, 0.999 * limit)(generator);
    }
    for (const auto i : {config::reg_search_span, config::reg_drive_limit, config::reg_quadrature_limit,
                         config::reg_rebalance_limit}) {
      values[i] = std::abs(values[i]);  // the contract has no others
    }
    if (round % 3 == 0) tests::set_quick_start_up(values, generator);
    values[config::reg_log2_block] = 0;
    values[config::reg_slope_shift] = round;
    const auto rtl = tb::make_rtl_engine(wide(), {.checks = true});
    const auto hls = tb::make_hls_engine(wide());
    for (tb::Engine* engine : {rtl.get(), hls.get()}) engine->reset(values);
    std::vector<tb::SamplePair> pairs;
    tests::append(pairs, tests::Stretch::tone, 30000, wide(), 4425.0, 3.0, generator);
    tests::append(pairs, tests::Stretch::overdriven, 3000, wide(), 4425.0, 3.0, generator);
    std::vector<tb::Record> records;
    expect_equal(wide(), *rtl, *hls, pairs, records);
    if (HasFatalFailure()) return;
  }
}

// Constant inputs at the rails under a nearly standing nco give basebands of 0.45 and more, which no tone
// does: turned by c = s = 2 they clip, and 1023 x 625 of them exceed the rate word. An increment at its own
// rail clips at once.
TEST_P(RtlEngine, ReachesTheClipsThatNoToneReaches) {
  const int rail = 1 << ((wide() ? config::Wide::adc_bits : config::Reference::adc_bits) - 1);
  const std::vector<tb::SamplePair> pairs(60000, tb::SamplePair{rail - 1, -rail, false});
  std::uint64_t seen = 0;
  for (const double start : {1e-4, 0.9999, -0.9999}) {
    auto values = tests::busy_registers(wide(), 0.0);
    values[config::reg_nco_start] = start;
    values[config::reg_amplitude_threshold] = start < 0.5 && start > 0 ? 1.9 : -1.9;
    values[config::reg_loop_proportional] = 0.0078;
    values[config::reg_loop_integral] = 7e-6;
    values[config::reg_loop_frequency] = 0.0078;
    values[config::reg_demodulation_cos] = 1.999;
    values[config::reg_demodulation_sin] = 1.999;
    values[config::reg_rate_gain] = 1023.9;
    values[config::reg_scale_correction] = 0.06;
    const auto rtl = tb::make_rtl_engine(wide(), {.checks = true});
    const auto hls = tb::make_hls_engine(wide());
    for (tb::Engine* engine : {rtl.get(), hls.get()}) engine->reset(values);
    std::vector<tb::Record> records;
    expect_equal(wide(), *rtl, *hls, pairs, records);
    if (HasFatalFailure()) return;
    for (const tb::Record& record : records)
      seen |= static_cast<std::uint64_t>(record.words[config::word_status]);
  }
  for (const auto bit : {config::status_secondary_saturated, config::status_loop_saturated,
                         config::status_rate_saturated, config::status_compensation_saturated}) {
    EXPECT_TRUE((seen >> bit) & 1) << config::status_names[bit];
  }
}

TEST_P(RtlEngine, ResetInMidStreamStartsAfresh) {
  const auto rtl = tb::make_rtl_engine(wide(), {.checks = true});
  const auto values = tests::busy_registers(wide(), 4410.0);
  const auto pairs = tests::hostile_capture(wide(), 2500, 9);
  rtl->reset(values);
  std::vector<tb::Record> before;
  // Not a whole number of ticks or outputs.
  rtl->samples(std::span(pairs.data(), 20011), before);
  const auto hls = tb::make_hls_engine(wide());
  for (tb::Engine* engine : {rtl.get(), hls.get()}) engine->reset(values);
  std::vector<tb::Record> records;
  expect_equal(wide(), *rtl, *hls, pairs, records);
}

TEST_P(RtlEngine, RecordComesOutWithoutFurtherSamples) {
  const auto rtl = tb::make_rtl_engine(wide());
  rtl->reset(tests::busy_registers(wide(), 4410.0));
  const std::vector<tb::SamplePair> pairs(
      static_cast<std::size_t>(decimation(wide()) * config::ticks_per_output));
  std::vector<tb::Record> records;
  rtl->samples(std::span(pairs.data(), pairs.size() - 1), records);
  EXPECT_TRUE(records.empty());
  rtl->samples(std::span(pairs.data() + pairs.size() - 1, 1), records);
  EXPECT_EQ(records.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Instruments, RtlEngine, testing::Bool(),
                         [](const auto& instance) { return instance.param ? "wide" : "reference"; });

}  // namespace

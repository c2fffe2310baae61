// SPDX-License-Identifier: Apache-2.0
// The SystemC bench: RTL and hls core as modules on one clock, one scoreboard; its records against the golden
// model's.
#include <gtest/gtest.h>

#include "tb/golden_engine.hpp"
#include "tb/hls_engine.hpp"
#include "tb/systemc_engine.hpp"
#include "tests/rtl/stand_in_plant.hpp"
#include "tests/tb/signals.hpp"

namespace {

using namespace hemi;

class SystemC : public testing::TestWithParam<bool> {};

TEST_P(SystemC, EqualsGoldenUnderGapsAndBackPressureAndAfterAReset) {
  const bool wide = GetParam();
  const auto golden = tb::make_golden_engine(wide, golden::Precision::quantised);
  // The second round starts from the state that the first has left: reset must clear all of it.
  for (const unsigned seed : {41u, 42u}) {
    tb::RtlOptions options;
    options.seed = seed;
    options.input_gap_probability = 0.2;
    options.back_pressure_probability = 0.4;
    const auto systemc = tb::make_systemc_engine(wide, options);
    const auto pairs = tests::hostile_capture(wide, 2500, seed);
    std::vector<tb::Record> a, b;
    golden->reset(tests::busy_registers(wide, 4410.0));
    systemc->reset(tests::busy_registers(wide, 4410.0));
    golden->samples(pairs, a);
    for (std::size_t at = 0; at < pairs.size(); at += 7001) {
      systemc->samples(std::span(pairs).subspan(at, std::min<std::size_t>(7001, pairs.size() - at)), b);
    }
    ASSERT_FALSE(a.empty());
    EXPECT_EQ(a, b);
    for (int i = 0; i < 40; ++i) {
      golden->telemetry(4430.0 + 0.01 * i, 12.5 * i, i % 9 != 3, a);
      systemc->telemetry(4430.0 + 0.01 * i, 12.5 * i, i % 9 != 3, b);
    }
    EXPECT_EQ(a, b);
  }
}

/// The same loop without SystemC.
void close_with_hls(tb::Engine& hls, tests::StandInPlant& plant, std::size_t samples,
                    std::vector<tb::Record>& records) {
  for (std::size_t i = 0; i < samples; ++i) plant.act(hls.step(plant.sample(), records));
}

TEST_P(SystemC, ClosesAPlantAroundBothCoresUnderGapsAndBackPressure) {
  const bool wide = GetParam();
  const auto hls = tb::make_hls_engine(wide);
  const auto values = tests::stand_in_registers(wide);
  tb::RtlOptions options;
  options.input_gap_probability = 0.3;
  options.back_pressure_probability = 0.5;
  const auto systemc = tb::make_systemc_engine(wide, options);
  for (tb::Engine* engine : {static_cast<tb::Engine*>(systemc.get()), hls.get()}) engine->reset(values);
  tests::StandInPlant plant(wide, 5), same_plant(wide, 5);
  std::vector<tb::Record> a, b;
  // Long enough for search, lock and the rise of the amplitude; a second call goes on where the first ended.
  const std::size_t samples = wide ? 35001 : 15001;
  for (int call = 0; call < 2; ++call) {
    systemc->closed_loop(plant, samples, a);
    close_with_hls(*hls, same_plant, samples, b);
    ASSERT_FALSE(a.empty());
    ASSERT_EQ(a, b);
  }
  const auto run = static_cast<std::uint64_t>(a.back().words[config::word_status]);
  EXPECT_FALSE((run >> config::status_starting) & 1) << "the plant was to be in operation";
  // Sample by sample, and recorded samples in between.
  for (int i = 0; i < 2000; ++i) {
    const tb::SamplePair pair = plant.sample();
    const tb::DacWords words = systemc->step(pair, a);
    ASSERT_EQ(words, hls->step(pair, b));
    plant.act(words);
    if (i == 1000) {
      const auto pairs = tests::hostile_capture(wide, 100, 6);
      systemc->samples(pairs, a);
      hls->samples(pairs, b);
    }
  }
  systemc->drain(a);
  EXPECT_EQ(a, b);
}

TEST_P(SystemC, EachSampleOfAPlantIsAnsweredOnce) {
  const bool wide = GetParam();
  const auto systemc = tb::make_systemc_engine(wide, {});
  systemc->reset(tests::stand_in_registers(wide));
  struct Stubborn : tb::PlantPort {
    int acted = 0;
    tb::SamplePair sample() override { return {acted % 100, -acted % 77, false}; }
    void act(const tb::DacWords&) override { ++acted; }
  } plant;
  std::vector<tb::Record> records;
  systemc->closed_loop(plant, 5000, records);
  EXPECT_EQ(plant.acted, 5000);
  EXPECT_EQ(records.size(), wide ? 4u : 10u);
}

INSTANTIATE_TEST_SUITE_P(Both, SystemC, testing::Bool(),
                         [](const auto& param_info) { return param_info.param ? "Wide" : "Reference"; });

}  // namespace

// SPDX-License-Identifier: Apache-2.0
// The SystemC bench: RTL and hls core as modules on one clock, one scoreboard; its records against the golden
// model's.
#include <gtest/gtest.h>

#include "tb/golden_engine.hpp"
#include "tb/systemc_engine.hpp"
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

INSTANTIATE_TEST_SUITE_P(Both, SystemC, testing::Bool(),
                         [](const auto& param_info) { return param_info.param ? "Wide" : "Reference"; });

}  // namespace

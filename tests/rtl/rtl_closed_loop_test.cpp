// SPDX-License-Identifier: Apache-2.0
// The RTL in closed loop against the fixed-point core: every word of every block and of the DAC ports.
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "tb/hls_engine.hpp"
#include "tb/scoreboard.hpp"
#include "tb/verilator_engine.hpp"
#include "tests/rtl/bits.hpp"
#include "tests/rtl/stand_in_plant.hpp"

namespace {

using namespace hemi;
using tests::bits_seen;
using tests::decimation;
using tests::expect_bits;

/// Passes on, and notes the order in which the start-up goes through its states: each pair of neighbours.
struct StateWatch : tb::TapSink {
  tb::TapSink* next = nullptr;
  std::int64_t last = 0;
  std::set<std::pair<std::int64_t, std::int64_t>> moves;
  void tap(config::TapIndex index, std::int64_t raw) override {
    if (index == config::tap_state) {
      moves.insert({last, raw});
      last = raw;
    }
    next->tap(index, raw);
  }
};

/// The plant follows the RTL's words, the hls core gets the same samples; fails at the first word that
/// differs, at a tap or at the DACs.
void expect_equal_closed_loop(bool wide, const tb::RtlOptions& options, const tb::RegisterValues& values,
                              std::uint64_t samples, std::vector<tb::Record>& records, StateWatch& watch) {
  const auto rtl = tb::make_rtl_engine(wide, options);
  const auto hls = tb::make_hls_engine(wide);
  for (tb::Engine* engine : {rtl.get(), hls.get()}) engine->reset(values);
  tb::Scoreboard scoreboard(decimation(wide));
  watch.next = &scoreboard.first();
  hls->set_taps(&watch);
  rtl->set_taps(&scoreboard.second());
  tests::StandInPlant plant(wide, 7);
  std::vector<tb::Record> expected;
  for (std::uint64_t n = 0; n < samples && !scoreboard.mismatch(); ++n) {
    const tb::SamplePair pair = plant.sample();
    const tb::DacWords words = rtl->step(pair, records);
    const tb::DacWords hls_words = hls->step(pair, expected);
    ASSERT_EQ(words.drive, hls_words.drive) << "sample " << n;
    ASSERT_EQ(words.rebalance, hls_words.rebalance) << "sample " << n;
    ASSERT_EQ(words.quadrature, hls_words.quadrature) << "sample " << n;
    plant.act(words);
    if (n % 4096 == 0) scoreboard.compare();
  }
  rtl->drain(records);
  scoreboard.finish();
  ASSERT_FALSE(scoreboard.mismatch()) << scoreboard.mismatch()->report("hls", "rtl");
  ASSERT_EQ(records, expected);
}

class RtlClosedLoop : public testing::TestWithParam<bool> {
 protected:
  bool wide() const { return GetParam(); }
};

TEST_P(RtlClosedLoop, EqualsHlsInClosedLoopThroughAllStates) {
  std::vector<tb::Record> records;
  StateWatch watch;
  expect_equal_closed_loop(wide(), {}, tests::stand_in_registers(wide()),
                           tests::StandInPlant::script_samples(wide()) + 20000, records, watch);
  using Moves = std::set<std::pair<std::int64_t, std::int64_t>>;
  using namespace config;
  // Searching on, signal found, lost before the lock, lock, closing, lock lost, hold-over at its end.
  const Moves wanted = {{state_search, state_search},  {state_search, state_acquire},
                        {state_acquire, state_search}, {state_acquire, state_rise},
                        {state_rise, state_run},       {state_run, state_acquire},
                        {state_run, state_search}};
  for (const auto& move : wanted)
    EXPECT_TRUE(watch.moves.count(move)) << "state " << move.first << " to " << move.second;
  expect_bits(bits_seen(records),
              {status_drive_saturated, status_quadrature_saturated, status_rebalance_saturated,
               status_searching, status_starting, status_holdover, status_unlocked, status_sample_gap});
}

TEST_P(RtlClosedLoop, ClosedLoopDoesNotDependOnGapsBackPressureOrClocks) {
  const tb::RtlOptions conditions[] = {
      {.seed = 3, .input_gap_probability = 0.97, .back_pressure_probability = 0.9, .checks = true},
      {.seed = 4, .back_pressure_probability = 0.997},
      {.clocks_per_sample = 120, .checks = true}};  // the words are there within 120 clocks
  for (const tb::RtlOptions& options : conditions) {
    std::vector<tb::Record> records;
    StateWatch watch;
    expect_equal_closed_loop(wide(), options, tests::stand_in_registers(wide()), 30000, records, watch);
    if (HasFatalFailure()) return;
  }
}

// Samples in one go and samples one by one are the same to the core, also in turns.
TEST_P(RtlClosedLoop, StepsAndStretchesMix) {
  const auto stepped = tb::make_rtl_engine(wide(), {.checks = true});
  const auto whole = tb::make_rtl_engine(wide());
  const auto values = tests::stand_in_registers(wide());
  for (tb::Engine* engine : {stepped.get(), whole.get()}) engine->reset(values);
  const auto pairs = tests::hostile_capture(wide(), 1500, 3);
  std::vector<tb::Record> a, b;
  for (std::size_t at = 0; at < pairs.size();) {
    for (int i = 0; i < 777 && at < pairs.size(); ++i) stepped->step(pairs[at++], a);
    const std::size_t n = std::min<std::size_t>(333, pairs.size() - at);
    stepped->samples(std::span(pairs).subspan(at, n), a);
    at += n;
  }
  stepped->drain(a);
  whole->samples(pairs, b);
  ASSERT_FALSE(b.empty());
  EXPECT_EQ(a, b);
}

TEST_P(RtlClosedLoop, ActuatorsRestWhileControlIsOff) {
  const auto rtl = tb::make_rtl_engine(wide(), {.checks = true});
  auto values = tests::stand_in_registers(wide());
  values[config::reg_control] = 0;
  rtl->reset(values);
  std::vector<tb::Record> records;
  for (const tb::SamplePair& pair : tests::hostile_capture(wide(), 500, 3)) {
    ASSERT_EQ(rtl->step(pair, records), tb::DacWords{});
  }
}

INSTANTIATE_TEST_SUITE_P(Instruments, RtlClosedLoop, testing::Bool(),
                         [](const auto& instance) { return instance.param ? "wide" : "reference"; });

}  // namespace

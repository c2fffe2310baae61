// SPDX-License-Identifier: Apache-2.0
// hemi_axi against the register model and, through its streams, against the fixed-point core.
#include <gtest/gtest.h>

#include "tb/hls_engine.hpp"
#include "tb/registers.hpp"
#include "tests/rtl/axi/axi_bench.hpp"
#include "tests/rtl/bits.hpp"
#include "tests/rtl/stand_in_plant.hpp"

namespace {

using namespace hemi;
using tests::AxiBench;
using tests::AxiModel;
using tests::Willingness;
using tests::Write;

/// Chooses accesses: registers mostly, everything that is there, and everything that is not.
class Stimulus {
 public:
  explicit Stimulus(unsigned seed) : random_(seed) {}

  std::uint32_t below(std::uint32_t n) {
    return std::uniform_int_distribution<std::uint32_t>(0, n - 1)(random_);
  }
  std::uint32_t word() { return static_cast<std::uint32_t>(random_()); }
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }

  std::uint32_t address() {
    const std::uint32_t kind = below(100);
    if (kind < 55) return 4 * below(2 * first_state_address);
    if (kind < 70) return AxiModel::record_base + 4 * below(2 * config::record_words);
    if (kind < 88) return AxiModel::identity + 4 * below(7);
    return below(4096);  // three of four are unaligned, most of the rest are unmapped
  }

  /// One access or the two halves of a register.
  void add_writes(std::deque<Write>& writes) {
    if (below(2) != 0) {
      const std::uint32_t at = 8 * below(first_state_address);
      writes.push_back({at, word()});
      if (below(8) == 0) writes.push_back(any_write());
      writes.push_back({at + 4, word()});
    } else {
      writes.push_back(any_write());
    }
  }

  Write any_write() { return {address(), word(), below(10) == 0 ? below(16) : 15u}; }

  /// From eager to reluctant, each channel for itself.
  Willingness mood() {
    const auto some = [this] {
      constexpr double levels[] = {1, 0.8, 0.5, 0.2, 0.05};
      return levels[below(5)];
    };
    return {some(), some(), some(), some(), some(), some(), some(), some()};
  }

 private:
  std::mt19937_64 random_;
};

void send_image(AxiBench& bench, const tb::RegisterImage& image) {
  for (int i = 0; i < config::register_count; ++i) {
    const auto address = static_cast<std::uint32_t>(8 * i);
    bench.writes.push_back({address, static_cast<std::uint32_t>(image[i])});
    bench.writes.push_back({address + 4, static_cast<std::uint32_t>(image[i] >> 32)});
  }
}

template <class Condition>
void run_until(AxiBench& bench, Condition condition) {
  for (int i = 0; !condition(); ++i) {
    if (i == 1000000) throw std::runtime_error("hemi_axi stands still");
    bench.clock();
  }
}

TEST(HemiAxi, RandomTransactionsUnderBackPressureAndResets) {
  AxiBench bench(11);
  Stimulus stimulus(12);
  std::uint64_t resets_in_transfer = 0;
  while (bench.transactions() < 1000000) {
    bench.willingness = stimulus.mood();
    const std::uint64_t until = bench.clocks + 50 + stimulus.below(3000);
    while (bench.clocks < until) {
      if (bench.writes.size() < 3) stimulus.add_writes(bench.writes);
      if (bench.reads.empty()) bench.reads.push_back(stimulus.address());
      if (bench.samples.empty()) {
        const auto adc = [&] { return static_cast<std::int32_t>(stimulus.below(65536)) - 32768; };
        bench.samples.push_back({{adc(), adc(), stimulus.below(9) == 0}, stimulus.below(3) == 0});
      }
      bench.clock();
      bench.dac_words.clear();
    }
    if (stimulus.below(4) == 0) {
      resets_in_transfer += bench.transfers_under_way();
      bench.reset(1 + static_cast<int>(stimulus.below(4)));
    }
  }
  const auto* responses = bench.responses;
  fmt::print(
      "{} transactions in {} clocks: {} OKAY, {} SLVERR, {} DECERR; {} clocks with both kinds, {} clocks of "
      "waiting, "
      "{} with an interrupt; {} resets in a transfer, {} records\n",
      bench.transactions(), bench.clocks, responses[0], responses[2], responses[3], bench.both, bench.waits,
      bench.interrupts, resets_in_transfer, bench.records.size());
  EXPECT_EQ(responses[1], 0u);
  for (const int code : {0, 2, 3}) EXPECT_GT(responses[code], 1000u);
  EXPECT_GT(bench.both, 10000u);
  EXPECT_GT(bench.waits, 10000u);
  EXPECT_GT(bench.interrupts, 1000u);
  EXPECT_GT(resets_in_transfer, 100u);
  EXPECT_GT(bench.records.size(), 500u);
}

/// Bus traffic that leaves the core's registers alone: reads of everything, writes elsewhere, and errors.
void add_harmless_traffic(AxiBench& bench, Stimulus& stimulus) {
  if (bench.reads.empty()) bench.reads.push_back(stimulus.address());
  if (!bench.writes.empty()) return;
  Write write = stimulus.any_write();
  if (AxiModel::is_register(write.address)) write.address &= ~4u;  // a low half alone commits nothing
  bench.writes.push_back(write);
}

void expect_records(const std::vector<AxiModel::RecordWords>& received,
                    const std::vector<tb::Record>& expected) {
  ASSERT_EQ(received.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    ASSERT_EQ(tb::to_record(received[i]), expected[i]) << "record " << i;
}

TEST(HemiAxi, StreamsEqualTheCoreInClosedLoopThroughAllStates) {
  constexpr std::uint64_t samples = tests::StandInPlant::script_samples(false) + 20000;
  AxiBench bench(21);
  Stimulus stimulus(22);
  const auto values = tests::stand_in_registers(false);
  const auto hls = tb::make_hls_engine(false);
  hls->reset(values);
  send_image(bench, tb::to_image(values));
  run_until(bench, [&] { return bench.idle(); });
  // The plant follows the core's words; those of hemi_axi are compared as they come.
  tests::StandInPlant plant(false, 7);
  std::deque<tb::DacWords> expected_words;
  std::vector<tb::Record> expected;
  std::uint64_t sent = 0, compared = 0;
  while (compared < samples) {
    if (sent % 2000 == 0) bench.willingness = stimulus.mood();
    if (sent < samples && bench.samples.empty()) {
      const tb::SamplePair pair = plant.sample();
      const tb::DacWords words = hls->step(pair, expected);
      plant.act(words);
      expected_words.push_back(words);
      bench.samples.push_back({pair, false});
      ++sent;
    }
    add_harmless_traffic(bench, stimulus);
    bench.clock();
    for (; !bench.dac_words.empty(); ++compared) {
      ASSERT_FALSE(expected_words.empty()) << "DAC words for no sample";
      ASSERT_EQ(bench.dac_words.front(), expected_words.front()) << "sample " << compared;
      bench.dac_words.pop_front();
      expected_words.pop_front();
    }
  }
  run_until(bench, [&] { return bench.records.size() >= expected.size(); });
  fmt::print("{} samples, {} records, {} transactions beside them\n", compared, expected.size(),
             bench.transactions());
  expect_records(bench.records, expected);
  using namespace config;
  tests::expect_bits(
      tests::bits_seen(expected),
      {status_drive_saturated, status_quadrature_saturated, status_rebalance_saturated, status_searching,
       status_starting, status_holdover, status_unlocked, status_sample_gap});
}

TEST(HemiAxi, TelemetryThroughTheRegisters) {
  AxiBench bench(31);
  Stimulus stimulus(32);
  const auto values = tests::busy_registers(false, 4410.0);
  const auto hls = tb::make_hls_engine(false);
  hls->reset(values);
  send_image(bench, tb::to_image(values));
  std::vector<tb::Record> expected;
  for (int i = 0; i < 500; ++i) {
    bench.willingness = stimulus.mood();
    const double frequency = stimulus.uniform(4430, 4434), rate = stimulus.uniform(-5e5, 5e5);
    const bool valid = i % 61 != 0;
    hls->telemetry(frequency, rate, valid, expected);
    const auto send = [&](int index, std::int64_t raw) {
      bench.writes.push_back({static_cast<std::uint32_t>(8 * index), static_cast<std::uint32_t>(raw)});
      bench.writes.push_back(
          {static_cast<std::uint32_t>(8 * index + 4), static_cast<std::uint32_t>(raw >> 32)});
    };
    send(telemetry_frequency_address, tb::to_raw(frequency, config::frequency, "frequency"));
    send(telemetry_rate_address, tb::to_raw(rate, config::rate, "rate"));
    run_until(bench, [&] { return bench.idle(); });
    bench.samples.push_back({{0, 0, !valid}, true});
    run_until(bench, [&] { return bench.records.size() == expected.size(); });
  }
  expect_records(bench.records, expected);
  EXPECT_TRUE(bench.dac_words.empty());
}

// The program's longest way from sample to sample is 115 clocks; 118 are what the core is specified for.
TEST(HemiAxi, TakesASampleEvery118Clocks) {
  AxiBench bench(51);
  const auto values = tests::busy_control(tests::busy_registers(false, 4410.0));
  send_image(bench, tb::to_image(values));
  run_until(bench, [&] { return bench.idle(); });
  const auto pairs = tests::hostile_capture(false, 1500, 19);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    bench.samples.push_back({pairs[i], false});
    bench.clock();
    ASSERT_FALSE(bench.sample_waits()) << "sample " << i << " is not taken at once";
    for (int clock = 1; clock < 118; ++clock) bench.clock();
    ASSERT_EQ(bench.dac_words.size(), i + 1) << "no DAC words in the sample's own clocks";
  }
  const std::size_t records = pairs.size() / (config::Reference::decimation * config::ticks_per_output);
  run_until(bench, [&] { return bench.records.size() == records; });
}

// A sink that takes no DAC words stops the samples behind two, and nothing is lost when it goes on.
TEST(HemiAxi, DacSinkThatStandsStillStopsTheSamples) {
  AxiBench bench(41);
  bench.willingness.dac = 0;
  for (int i = 0; i < 40; ++i) bench.samples.push_back({{i, -i, false}, false});
  for (int i = 0; i < 5000; ++i) bench.clock();
  EXPECT_EQ(bench.samples.size(), 37u);  // two taken, a third offered
  bench.willingness.dac = 1;
  run_until(bench, [&] { return bench.dac_words.size() == 40; });
}

}  // namespace

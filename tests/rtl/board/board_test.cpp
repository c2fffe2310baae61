// SPDX-License-Identifier: Apache-2.0
// The reference design, pins and all, in closed loop against the fixed-point core.
#include <gtest/gtest.h>

#include <algorithm>

#include "tb/board/bench.hpp"
#include "tb/board/host.hpp"
#include "tb/hls_engine.hpp"
#include "tb/registers.hpp"
#include "tests/rtl/bits.hpp"
#include "tests/rtl/stand_in_plant.hpp"

namespace {

using namespace hemi;

/// The host beside the bench: while it waits for bytes, clocks pass.
class BenchPort : public tb::LinkPort {
 public:
  explicit BenchPort(tb::BoardBench& bench) : bench_(bench) {}

  void write(std::span<const std::uint8_t> bytes) override {
    for (const std::uint8_t byte : bytes) bench_.send(byte);
  }

  std::vector<std::uint8_t> read() override {
    constexpr int patience = 2 * config::Reference::samples_per_output * board::sample_clocks;
    for (int i = 0; i < patience; ++i) {
      if (const auto byte = bench_.clock()) return {*byte};
    }
    return {};
  }

 private:
  tb::BoardBench& bench_;
};

/// Nothing moves.
class StillPlant : public tb::PlantPort {
 public:
  tb::SamplePair sample() override { return {1000, -1000, false}; }
  void act(const tb::DacWords& words) override { last = words; }
  tb::DacWords last;
};

constexpr int control = board::addresses[2].address;
constexpr int faults = board::addresses[3].address;

struct Board {
  explicit Board(tb::PlantPort& plant, double host_bit_clocks = board::baud_clocks)
      : bench(
            plant, [this](const tb::BoardPeriod& p) { periods.push_back(p); }, host_bit_clocks),
        port(bench),
        host(port) {}
  std::vector<tb::BoardPeriod> periods;
  tb::BoardBench bench;
  BenchPort port;
  tb::BoardHost host;
};

/// The plant closed around the hls core alone.
struct Alone {
  std::vector<tb::SamplePair> pairs;
  std::vector<tb::DacWords> words;
  std::vector<tb::Record> records;
};

Alone run_alone(tb::PlantPort& plant, const tb::RegisterValues& values, std::size_t samples) {
  Alone alone;
  const auto hls = tb::make_hls_engine(false);
  hls->reset(values);
  for (std::size_t n = 0; n < samples; ++n) {
    alone.pairs.push_back(plant.sample());
    // The board has no gap in its samples.
    alone.pairs.back().gap = false;
    alone.words.push_back(hls->step(alone.pairs.back(), alone.records));
    plant.act(alone.words.back());
  }
  return alone;
}

/// Sample by sample: what was converted, and that words of sample n are in force from n + 2 on.
void expect_same_loop(const std::vector<tb::BoardPeriod>& periods, const Alone& alone) {
  ASSERT_LE(periods.size(), alone.pairs.size());
  for (std::size_t n = 0; n < periods.size(); ++n) {
    ASSERT_EQ(periods[n].pair.x, alone.pairs[n].x) << "sample " << n;
    ASSERT_EQ(periods[n].pair.y, alone.pairs[n].y) << "sample " << n;
    ASSERT_EQ(periods[n].sent, n < 1 ? tb::DacWords{} : alone.words[n - 1]) << "sample " << n;
    ASSERT_EQ(periods[n].in_force, n < 2 ? tb::DacWords{} : alone.words[n - 2]) << "sample " << n;
  }
}

TEST(Board, EqualsHlsInClosedLoopThroughAllStates) {
  constexpr std::size_t records = 220;
  const auto values = tests::stand_in_registers(false);
  tests::StandInPlant plant(false, 7), same_plant(false, 7);
  Board board(plant);
  board.host.start(tb::to_image(values));
  std::vector<tb::Record> found;
  while (found.size() < records) found.push_back(board.host.record());
  EXPECT_EQ(board.host.faults(), 0);
  EXPECT_FALSE(board.bench.fault());
  Alone alone = run_alone(same_plant, values, board.periods.size());
  expect_same_loop(board.periods, alone);
  ASSERT_GE(alone.records.size(), records);
  alone.records.resize(records);
  EXPECT_EQ(found, alone.records);
  using namespace config;
  tests::expect_bits(tests::bits_seen(found),
                     {status_drive_saturated, status_quadrature_saturated, status_rebalance_saturated,
                      status_searching, status_starting, status_holdover, status_unlocked});
}

TEST(Board, TellsWhatItIs) {
  StillPlant plant;
  Board board(plant);
  board.host.identify();
  EXPECT_FALSE(board.bench.active());
  EXPECT_TRUE(board.periods.empty()) << "samples before the start";
}

// A host's oscillator may be off by as much as half a bit in ten, less the synchroniser's clock: 4 %.
TEST(Board, ToleratesTheHostsOscillator) {
  for (const double off : {0.96, 1.04}) {
    StillPlant plant;
    Board board(plant, off * board::baud_clocks);
    board.host.identify();
    board.host.write(config::reg_nco_start, -12345678901234);
    EXPECT_EQ(board.host.read(config::reg_nco_start), -12345678901234);
  }
}

TEST(Board, RegistersReadBackAndTheRestIsRefused) {
  StillPlant plant;
  Board board(plant);
  for (int address = 0; address < 256; ++address) {
    const bool is_register = address < first_state_address;
    const bool is_record =
        address >= board::record_base && address < board::record_base + config::record_words;
    const bool is_board = address >= 0x60 && address < 0x64;
    const std::int64_t word = (std::int64_t{1} << 53) - 7 * address;
    if (is_register) {
      board.host.write(address, -word);
    } else if (address != control && address != faults) {
      EXPECT_THROW(board.host.write(address, word), tb::LinkError) << address;
    }
    if (is_register || is_record || is_board)
      board.host.read(address);
    else
      EXPECT_THROW(board.host.read(address), tb::LinkError) << address;
  }
  for (int address = 0; address < first_state_address; ++address)
    EXPECT_EQ(board.host.read(address), -((std::int64_t{1} << 53) - 7 * address)) << address;
  // A reset stops, whatever else is asked for.
  board.host.write(control, board::control_reset | board::control_run);
  EXPECT_EQ(board.host.read(control), 0);
  for (int address = 0; address < first_state_address; ++address) EXPECT_EQ(board.host.read(address), 0);
}

TEST(Board, LastRecordIsReadOverTheLink) {
  tests::StandInPlant plant(false, 7);
  Board board(plant);
  board.host.start(tb::to_image(tests::stand_in_registers(false)));
  for (int i = 0; i < 3; ++i) board.host.record();
  const tb::Record last = board.host.record();
  std::vector<std::int64_t> words;
  for (int i = 0; i < config::record_words; ++i) words.push_back(board.host.read(board::record_base + i));
  EXPECT_EQ(tb::to_record(words), last);
}

// A spoilt request changes nothing and says so; the link goes on with the next.
TEST(Board, SpoiltRequestsAreFaultsAndNothingElse) {
  StillPlant plant;
  Board board(plant);
  board.host.write(5, 4711);
  for (std::size_t bit = 8; bit < 12 * 8; ++bit) {
    auto bytes = tb::link_request(true, 5, 1234567890123);
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1U << bit % 8);
    board.port.write(bytes);
    while (board.bench.sending()) board.bench.clock();
    ASSERT_EQ(board.host.faults(), board::fault_bad_request) << "bit " << bit;
    ASSERT_EQ(board.host.read(5), 4711) << "bit " << bit;
    board.host.write(faults, board::fault_bad_request);
    ASSERT_EQ(board.host.faults(), 0);
  }
  // A frame that breaks off is forgotten after a pause of 65536 clocks.
  auto half = tb::link_request(true, 5, 1);
  half.resize(7);
  board.port.write(half);
  for (int i = 0; i < 90000; ++i) board.bench.clock();
  EXPECT_EQ(board.host.read(5), 4711);
  // So are bytes between frames.
  board.port.write(std::vector<std::uint8_t>{0x00, 0xff, 0x5a, 0xc3});
  EXPECT_EQ(board.host.read(5), 4711);
  EXPECT_EQ(board.host.faults(), 0);
}

TEST(Board, RequestBeforeTheAnswerIsAFault) {
  StillPlant plant;
  Board board(plant);
  for (int i = 0; i < 3; ++i) board.port.write(tb::link_request(true, 5, 100 + i));
  while (board.bench.sending()) board.bench.clock();
  for (int i = 0; i < 10000; ++i) board.bench.clock();
  EXPECT_NE(board.host.faults() & board::fault_request_lost, 0);
  EXPECT_NE(board.host.read(5), 101) << "the second came while the first was being answered";
}

TEST(Board, StopBringsTheActuatorsToRestAndLeavesAGap) {
  tests::StandInPlant plant(false, 7);
  Board board(plant);
  auto values = tests::stand_in_registers(false);
  board.host.start(tb::to_image(values));
  for (int i = 0; i < 40; ++i) {
    const auto status = static_cast<std::uint64_t>(board.host.record().words[config::word_status]);
    ASSERT_EQ(status >> config::status_sample_gap & 1, 0U) << "record " << i;
  }
  ASSERT_NE(board.periods.back().sent, tb::DacWords{});
  board.host.stop();
  const std::size_t sampled = board.periods.size();
  for (int i = 0; i < 5 * board::sample_clocks; ++i) board.bench.clock();
  EXPECT_LE(board.periods.size(), sampled + 1);
  EXPECT_FALSE(board.bench.active());
  EXPECT_EQ(board.bench.waiting(), tb::DacWords{});
  board.host.write(control, board::control_run);
  const auto status = static_cast<std::uint64_t>(board.host.record().words[config::word_status]);
  EXPECT_EQ(status >> config::status_sample_gap & 1, 1U);
  EXPECT_EQ(board.host.faults(), 0);
}

// After a reset records count from 0 again, and the core knows nothing of before.
TEST(Board, StartsAnewAfterAReset) {
  const auto values = tests::stand_in_registers(false);
  tests::StandInPlant plant(false, 7);
  Board board(plant);
  board.host.start(tb::to_image(values));
  for (int i = 0; i < 7; ++i) board.host.record();
  board.host.stop();
  const std::size_t first = board.periods.size() + 1;  // one may be under way
  for (int i = 0; i < 3 * board::sample_clocks; ++i) board.bench.clock();
  ASSERT_LE(board.periods.size(), first);
  const std::size_t restart = board.periods.size();
  board.host.start(tb::to_image(values));
  std::vector<tb::Record> found, expected;
  while (found.size() < 9) found.push_back(board.host.record());
  const auto hls = tb::make_hls_engine(false);
  hls->reset(values);
  for (std::size_t n = restart; n < board.periods.size(); ++n) hls->step(board.periods[n].pair, expected);
  ASSERT_GE(expected.size(), found.size());
  expected.resize(found.size());
  EXPECT_EQ(found, expected);
}

// Words that the reset has cleared do not go out under a good CRC.
TEST(Board, AResetBreaksARecordOff) {
  tests::StandInPlant plant(false, 7);
  Board board(plant);
  board.host.start(tb::to_image(tests::stand_in_registers(false)));
  for (int i = 0; i < 3; ++i) board.host.record();
  tb::LinkDecoder decoder;
  const auto first = board.port.read();
  ASSERT_EQ(first, std::vector<std::uint8_t>{board::record_header});
  decoder.push(first[0]);
  board.port.write(tb::link_request(true, control, board::control_reset));
  constexpr int frame_clocks = 11 * board::record_bytes * board::baud_clocks;
  for (int i = 0; i < 2 * frame_clocks; ++i) {
    if (const auto byte = board.bench.clock()) decoder.push(*byte);
  }
  EXPECT_FALSE(decoder.next());
  decoder.give_up();
  const auto answer = decoder.next();
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->record);
  EXPECT_EQ(answer->address, control);
  EXPECT_FALSE(decoder.next());
}

}  // namespace

// SPDX-License-Identifier: Apache-2.0
// The tops give what the classes give that they wrap: a chain of tops equals the core in every block's
// output, and the core's top equals the core.
#include <gtest/gtest.h>

#include "hls/core.hpp"
#include "hls/tops/tops.hpp"
#include "tests/hls/tops/chain.hpp"
#include "tests/hls/tops/signals.hpp"

namespace {

using namespace hemi;
using Words = tests::TopChain::Words;

/// All words of each tap in their order.
struct Taps : tb::TapSink {
  std::array<std::vector<std::int64_t>, config::tap_count> words;
  void tap(config::TapIndex index, std::int64_t raw) override { words[index].push_back(raw); }
  template <class T>
  void operator()(config::TapIndex index, const T& value) {
    tap(index, hls::raw(value));
  }
};

void load(const tb::RegisterImage& image, std::int64_t (&words)[config::register_count]) {
  for (int i = 0; i < config::register_count; ++i) words[i] = image[i];
}

Words words_of(const hls::Record& record) {
  Words words;
  std::copy(std::begin(record.word), std::end(record.word), words.begin());
  return words;
}

void expect_same_taps(const Taps& core, const Taps& chain) {
  for (int i = 0; i < config::tap_count; ++i) {
    if (i == config::tap_dac_quadrature) continue;  // the chain has it sample by sample
    EXPECT_EQ(core.words[i], chain.words[i]) << config::taps[i].block << ' ' << config::taps[i].name;
    EXPECT_FALSE(core.words[i].empty()) << config::taps[i].name;
  }
}

TEST(Tops, ChainOfThemEqualsTheCoreInEveryBlock) {
  const auto image = tests::top_registers();
  std::int64_t registers[config::register_count];
  load(image, registers);
  hls::Core<config::Reference> core;
  Taps core_taps, chain_taps;
  tests::Recorder recorder(0);
  tests::TopChain chain(recorder, chain_taps);
  std::uint64_t seen = 0;
  for (int pass = 0; pass < 2; ++pass) {  // the second one starts from what the first one left
    core.reset(registers);
    chain.reset(image);
    std::size_t records = 0, n = 0;
    for (const auto& pair : tests::top_capture(200000)) {
      hls::Record record;
      const bool complete = core.sample(pair.x, pair.y, pair.gap, record, core_taps);
      const auto words = chain.sample(pair.x, pair.y, pair.gap);
      ASSERT_EQ(words.has_value(), complete) << "sample " << n;
      if (complete) {
        ASSERT_EQ(*words, words_of(record)) << "record " << records;
        seen |= static_cast<std::uint64_t>((*words)[config::word_status]);
        ++records;
      }
      ASSERT_EQ(chain.dac().drive, core.dac_drive()) << "sample " << n;
      ASSERT_EQ(chain.dac().rebalance, core.dac_rebalance()) << "sample " << n;
      ASSERT_EQ(chain.dac().quadrature, core.dac_quadrature()) << "sample " << n;
      ++n;
    }
    EXPECT_GE(records, 400u);
    for (const auto& t : tests::top_telemetry(2500)) {
      hls::Record record;
      core.telemetry(t.frequency, t.rate, t.valid, record, core_taps);
      ASSERT_EQ(chain.telemetry(t.frequency, t.rate, t.valid), words_of(record));
    }
  }
  expect_same_taps(core_taps, chain_taps);
  // The signals reached what is worth comparing.
  for (const auto bit : {config::status_unlocked, config::status_holdover, config::status_adc_overload,
                         config::status_drive_saturated, config::status_quadrature_saturated,
                         config::status_searching, config::status_starting})
    EXPECT_TRUE((seen >> bit) & 1) << config::status_names[bit];
}

template <class Instrument, class Top>
void expect_top_equals_core(Top* top, bool wide) {
  const auto image = tb::to_image(tests::busy_control(tests::busy_registers(wide, 4410.0)));
  std::int64_t registers[config::register_count];
  load(image, registers);
  hls::Core<Instrument> core;
  hls::NoProbe probe;
  bool valid;
  Words words{};
  std::int32_t drive, rebalance, quadrature;
  const auto call = [&](bool write, int address, std::int64_t data, bool reset, bool telemetry,
                        const tb::SamplePair& pair, std::int64_t frequency, std::int64_t rate) {
    top(write, address, data, reset, telemetry, pair.x, pair.y, pair.gap, frequency, rate, &valid,
        words.data(), &drive, &rebalance, &quadrature);
  };
  for (int i = 0; i < config::register_count; ++i) call(true, i, image[i], false, false, {}, 0, 0);
  call(true, config::register_count, 1, false, false, {}, 0, 0);  // no such register: nothing happens
  call(true, -1, 1, false, false, {}, 0, 0);
  for (int pass = 0; pass < 2; ++pass) {
    core.reset(registers);
    call(false, 0, 0, true, false, {}, 0, 0);
    EXPECT_FALSE(valid);
    hls::Record record;
    std::size_t records = 0;
    for (const auto& pair : tests::hostile_capture(wide, 1500, 17)) {
      const bool complete = core.sample(pair.x, pair.y, pair.gap, record, probe);
      call(false, 0, 0, false, false, pair, 0, 0);
      ASSERT_EQ(valid, complete);
      if (complete) ++records;
      if (records > 0) {  // before the first one, the words are the caller's
        ASSERT_EQ(words, words_of(record));
      }
      ASSERT_EQ(drive, core.dac_drive());
      ASSERT_EQ(rebalance, core.dac_rebalance());
      ASSERT_EQ(quadrature, core.dac_quadrature());
    }
    EXPECT_GE(records, 20u);
    for (const auto& t : tests::top_telemetry(500)) {
      core.telemetry(t.frequency, t.rate, t.valid, record, probe);
      call(false, 0, 0, false, true, {0, 0, !t.valid}, t.frequency, t.rate);
      ASSERT_TRUE(valid);
      ASSERT_EQ(words, words_of(record));
    }
  }
}

TEST(Tops, OfTheCoreEqualsTheCoreReference) {
  expect_top_equals_core<config::Reference>(hemi_core_reference, false);
}

TEST(Tops, OfTheCoreEqualsTheCoreWide) {
  expect_top_equals_core<config::Wide>(hemi_core_wide, true);
}

}  // namespace

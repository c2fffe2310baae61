// SPDX-License-Identifier: Apache-2.0
// Golden model against the engine that this program is linked with, which may be mutated. Prints what the
// scoreboard says and, found by comparing complete traces, what it should say: "BLOCK WORD SAMPLE" twice.
// Argument: sample pairs in a thirty-second of the capture, 1000 if there is none.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "tb/golden_engine.hpp"
#include "tb/scoreboard.hpp"
#include "tests/tb/mutant_engine.hpp"
#include "tests/tb/signals.hpp"

namespace {

using namespace hemi;

struct Trace : tb::TapSink {
  std::array<std::vector<std::int64_t>, config::tap_count> words;
  tb::TapSink* next = nullptr;
  void tap(config::TapIndex index, std::int64_t raw) override {
    words[index].push_back(raw);
    next->tap(index, raw);
  }
};

std::string by_traces(const Trace& a, const Trace& b, std::uint64_t samples) {
  constexpr std::uint64_t r = config::Reference::decimation;
  for (std::uint64_t n = 0; n < samples; ++n) {
    for (int i = 0; i < config::tap_count; ++i) {
      const auto rate = config::taps[i].rate;
      const std::uint64_t period = rate == config::TapRate::sample ? 1
                                   : rate == config::TapRate::tick ? r
                                                                   : r * config::ticks_per_output;
      if ((n + 1) % period != 0) continue;
      const std::size_t k = (n + 1) / period - 1;
      const auto& u = a.words[i];
      const auto& v = b.words[i];
      if (k < u.size() && k < v.size() && u[k] == v[k]) continue;
      return fmt::format("{} {} {}", config::taps[i].block, config::taps[i].name, n);
    }
  }
  return "none";
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t unit = argc > 1 ? std::stoul(argv[1]) : 1000;
  // Short enough for a slow engine, long enough for lock, hold-over, loss of lock by a jump of frequency, two
  // windows of df/dt and a gap.
  std::mt19937_64 generator(31);
  std::vector<tb::SamplePair> pairs;
  tests::append(pairs, tests::Stretch::tone, 24 * unit, false, 4425.0, 3.0, generator);
  tests::append(pairs, tests::Stretch::silence, unit, false, 4425.0, 0.5, generator);
  tests::append(pairs, tests::Stretch::overdriven, 3 * unit, false, 4425.0, 0.5, generator);
  tests::append(pairs, tests::Stretch::tone, 4 * unit, false, 4475.0, 3.0, generator);
  pairs[9 * unit].gap = true;
  auto values = tests::busy_control(tests::busy_registers(false, 4420.0));
  values[config::reg_log2_block] = 0;
  values[config::reg_lock_count] = 60;
  values[config::reg_slope_shift] = 3;
  const auto golden = tb::make_golden_engine(false, golden::Precision::quantised);
  const auto mutant = tests::make_mutant_engine();
  tb::Scoreboard scoreboard(config::Reference::decimation);
  Trace a, b;
  a.next = &scoreboard.first();
  b.next = &scoreboard.second();
  golden->reset(values);
  mutant->reset(values);
  golden->set_taps(&a);
  mutant->set_taps(&b);
  std::vector<tb::Record> ra, rb;
  for (std::size_t at = 0; at < pairs.size() && !scoreboard.mismatch(); at += 2000) {
    const std::span chunk(pairs.data() + at, std::min<std::size_t>(2000, pairs.size() - at));
    golden->samples(chunk, ra);
    mutant->samples(chunk, rb);
    scoreboard.compare();
  }
  scoreboard.finish();
  if (!scoreboard.mismatch()) {
    fmt::print("none\n{}\n{}\n", by_traces(a, b, pairs.size()),
               ra == rb ? "records equal" : "records differ");
    return 0;
  }
  const auto& m = *scoreboard.mismatch();
  fmt::print("{} {} {}\n{}\n", config::taps[m.tap].block, config::taps[m.tap].name, m.sample,
             by_traces(a, b, pairs.size()));
  return 1;
}

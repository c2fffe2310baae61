// SPDX-License-Identifier: Apache-2.0
// hls_vectors DIRECTORY: writes the inputs of each top's calls over the regression's signals to
// DIRECTORY/TOP.vectors, rows of 64-bit words, lowest byte first.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

#include "hls/tops/tops.hpp"
#include "tests/hls/tops/chain.hpp"
#include "tests/hls/tops/signals.hpp"

namespace {

using namespace hemi;
using tests::Recorder;

constexpr std::size_t calls = 20200;        ///< of each top with the regression's signals, at least
constexpr std::size_t random_calls = 1800;  ///< after them, with any words at all

struct Deaf : tb::TapSink {
  void tap(config::TapIndex, std::int64_t) override {}
};

void write(const std::filesystem::path& directory, const std::string& name, const tests::CallLog& log) {
  const auto path = directory / (name + ".vectors");
  std::ofstream file(path, std::ios::binary);
  for (const std::int64_t word : log.words) {
    char bytes[8];
    for (int i = 0; i < 8; ++i) bytes[i] = static_cast<char>(static_cast<std::uint64_t>(word) >> (8 * i));
    file.write(bytes, sizeof bytes);
  }
  file.flush();
  if (!file) {
    std::cerr << "hls_vectors: cannot write " << path << '\n';
    std::exit(2);
  }
  std::cout << name << ": " << log.rows() << " calls\n";
}

/// What the chain of tops hears of `pairs`, and of telemetry behind them.
Recorder chain_calls(std::size_t limit, std::size_t pairs, std::size_t outputs) {
  Recorder recorder(limit);
  Deaf deaf;
  tests::TopChain chain(recorder, deaf);
  chain.reset(tests::top_registers());
  for (const auto& pair : tests::top_capture(pairs)) chain.sample(pair.x, pair.y, pair.gap);
  for (const auto& t : tests::top_telemetry(outputs)) chain.telemetry(t.frequency, t.rate, t.valid);
  return recorder;
}

template <class Core>
void core_calls(Recorder& recorder, const std::string& name, Core* core, bool wide) {
  bool valid;
  std::int64_t record[config::record_words];
  std::int32_t dac[3];
  const auto call = [&](auto... inputs) {
    recorder(name, core, inputs..., &valid, &record[0], &dac[0], &dac[1], &dac[2]);
  };
  const auto image = tb::to_image(tests::busy_control(tests::busy_registers(wide, 4410.0)));
  for (int i = 0; i < config::register_count; ++i) call(true, i, image[i], false, false, 0, 0, false, 0, 0);
  call(false, 0, 0, true, false, 0, 0, false, 0, 0);
  for (const auto& pair : tests::hostile_capture(wide, calls / 18 + 1, 17))
    call(false, 0, 0, false, false, pair.x, pair.y, pair.gap, 0, 0);
  for (const auto& t : tests::top_telemetry(300))
    call(false, 0, 0, false, true, 0, 0, !t.valid, t.frequency, t.rate);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: hls_vectors DIRECTORY\n";
    return 2;
  }
  const std::filesystem::path directory = argv[1];
  std::filesystem::create_directories(directory);
  // Each kernel by its own rate: a long capture gives ticks enough, telemetry outputs.
  const std::set<std::string> at_samples = {"hemi_nco", "hemi_demodulator", "hemi_cic", "hemi_modulator"};
  Recorder samples = chain_calls(calls, calls, 0);
  Recorder ticks = chain_calls(calls, calls * config::Reference::decimation, calls);
  for (auto* recorder : {&samples, &ticks}) {
    recorder->add_random(random_calls, 29);
    for (const auto& [name, log] : recorder->logs())
      if (at_samples.contains(name) == (recorder == &samples)) write(directory, name, log);
  }
  Recorder cores(10 * calls);
  core_calls(cores, "hemi_core_reference", hemi_core_reference, false);
  core_calls(cores, "hemi_core_wide", hemi_core_wide, true);
  for (const auto& [name, log] : cores.logs()) write(directory, name, log);
}

// SPDX-License-Identifier: Apache-2.0
#include "cli/capture_replay.hpp"

#include <algorithm>
#include <span>

#include "tb/hls_engine.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {

diagnosis::Replay make_replay(const std::vector<tb::SamplePair>& pairs, bool wide) {
  return [&pairs, wide](const diagnosis::CoreRegisters& registers, std::size_t samples, bool dacs) {
    diagnosis::Replayed replayed;
    const auto engine = tb::make_hls_engine(wide);
    try {
      engine->reset(registers);
    } catch (const tb::FormatError&) {
      return replayed;
    }
    const std::span<const tb::SamplePair> part(pairs.data(), std::min(samples, pairs.size()));
    std::vector<tb::Record> records;
    if (dacs) {
      replayed.dacs.reserve(part.size());
      for (const auto& pair : part) {
        const tb::DacWords words = engine->step(pair, records);
        replayed.dacs.push_back({words.drive, words.rebalance, words.quadrature});
      }
    } else {
      engine->samples(part, records);
    }
    replayed.records.reserve(records.size());
    for (const auto& record : records) replayed.records.push_back(record.words);
    return replayed;
  };
}

}  // namespace hemi::cli

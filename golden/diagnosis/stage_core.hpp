// SPDX-License-Identifier: Apache-2.0
// Recorded words against those that the core computes from the recorded samples.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hls/config.hpp"

namespace hemi::diagnosis {

using CoreRegisters = std::array<double, config::register_count>;  ///< in their units
using CoreWords =
    std::array<double, config::record_words>;  ///< a record, units of docs/chain.md; NaN: not recorded
using CoreDacs = std::array<std::int32_t, 3>;  ///< drive, rebalance, quadrature, raw

struct Replayed {
  std::vector<CoreWords> records;
  std::vector<CoreDacs> dacs;  ///< one a sample where asked for
};

/// Runs the first `samples` of the capture through the core from its reset. Empty for registers that their
/// formats cannot hold.
using Replay = std::function<Replayed(const CoreRegisters& registers, std::size_t samples, bool dacs)>;

struct RecordedWords {
  std::vector<CoreWords> records;  ///< record i is output i of the core
  CoreWords tolerance{};           ///< a larger difference is one; what the recording's own rounding allows
  std::size_t samples_a_record = 0;
};

/// A register whose other value makes every recorded word.
struct RegisterCandidate {
  config::RegisterIndex index;
  double nominal;
  double found;
};

struct CoreComparison {
  std::size_t compared = 0;  ///< words
  std::size_t differing = 0;
  std::array<bool, config::record_words> differs{};
  std::optional<std::size_t> first_record;   ///< of a difference
  std::string block;                         ///< earliest that can have made the first differences
  std::vector<RegisterCandidate> registers;  ///< each alone explains all
  std::optional<double> demodulation_rad;    ///< phase in demodulation_cos and _sin that explains all
  CoreRegisters explaining{};  ///< the first explanation; the given registers where there is none
  bool explained() const { return !registers.empty() || demodulation_rad.has_value(); }
};

/// Compares, and where words differ tries every register, and the demodulation phase, for a value that
/// explains them all: Newton's steps on the differences, then every single flipped bit.
CoreComparison compare_core(const RecordedWords& recorded, const CoreRegisters& registers,
                            const Replay& replay);

}  // namespace hemi::diagnosis

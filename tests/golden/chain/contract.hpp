// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/golden/chain/support.hpp"
#include "tests/golden/chain/whole_numbers.hpp"

namespace hemi::golden::testing {

/// All taps in the order of their emission.
class Recorder : public TapListener {
 public:
  void tap(config::TapIndex index, double value) override { taps_.emplace_back(index, value); }
  std::vector<std::pair<config::TapIndex, double>> taps_;
};

/// In [-1, 1).
double uniform(std::mt19937_64& random);

/// Words of either end, of the middle and in between; shifts, block lengths and limits in their ranges,
/// amplitude thresholds in their order. kind 0: a loop that locks.
RegisterValues random_registers(const InstrumentParameters& instrument, std::mt19937_64& random, int kind);

/// Every tap, in value and place. status_seen collects the live bits.
void expect_equal(const Recorder& recorder, const WholeNumbers& expected, const std::string& what,
                  std::uint64_t& status_seen);

/// The record words that are sums of taps over the ticks of two output intervals.
void expect_sums(const Recorder& recorder, const std::vector<ChainRecord>& records, const std::string& what);

}  // namespace hemi::golden::testing

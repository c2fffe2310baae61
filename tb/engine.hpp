// SPDX-License-Identifier: Apache-2.0
// One interface for every engine of the chain, so that one scoreboard and one program serve them all.
#ifndef HEMI_TB_ENGINE_HPP
#define HEMI_TB_ENGINE_HPP

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hls/config.hpp"

namespace hemi::tb {

/// One pair of ADC words [LSB]; `gap` says that samples were lost just before this one.
struct SamplePair {
  std::int32_t x = 0;
  std::int32_t y = 0;
  bool gap = false;
};

/// Register contents in their own units (config::registers), before rounding.
using RegisterValues = std::array<double, config::register_count>;

/// Register contents as the core holds them: raw words, parity included.
using RegisterImage = std::array<std::int64_t, config::register_count>;

/// One output record: words in the units of docs/chain.md; exact in a double for every fixed-point engine.
struct Record {
  std::array<double, config::record_words> words{};
  bool operator==(const Record&) const = default;
};

/// What the three DACs get from one sample, raw words of config::dac; they act two samples later.
struct DacWords {
  std::int32_t drive = 0;
  std::int32_t rebalance = 0;
  std::int32_t quadrature = 0;
  bool operator==(const DacWords&) const = default;
};

/// Receives the outputs of the blocks; within one tap the values come in order of time.
class TapSink {
 public:
  virtual ~TapSink() = default;
  /// `raw` is the word as an integer, value = raw * 2^-fraction (config::taps).
  virtual void tap(config::TapIndex index, std::int64_t raw) = 0;
};

/// An engine is reset once, then fed; it appends each record that becomes complete.
/// Engines that run a clock may apply random gaps and back-pressure: the records do not depend on them.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual std::string name() const = 0;
  /// Loads the registers and starts from sample 0. Fixed-point engines quantise with to_image().
  virtual void reset(const RegisterValues& values) = 0;
  /// Feeds sample pairs in at the ADC.
  virtual void samples(std::span<const SamplePair> input, std::vector<Record>& output) = 0;
  /// Feeds one sample pair in and returns its DAC words: the closed loop's way. A clocked engine may hand a
  /// record over some samples after the one that completed it; drain() brings what is left.
  virtual DacWords step(const SamplePair& sample, std::vector<Record>& output) = 0;
  virtual void drain(std::vector<Record>& /*output*/) {}
  /// Feeds one telemetry sample in behind the tracker: frequency [nominal Hz], rate [deg/h]; appends one
  /// record.
  virtual void telemetry(double frequency_hz, double rate_dph, bool valid, std::vector<Record>& output) = 0;
  /// Taps from now on go to `sink`; nullptr for none. Engines without taps ignore it.
  virtual void set_taps(TapSink* sink) = 0;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_ENGINE_HPP

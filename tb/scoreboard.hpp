// SPDX-License-Identifier: Apache-2.0
// The scoreboard of every bench: two engines' taps in, the first difference out.
#ifndef HEMI_TB_SCOREBOARD_HPP
#define HEMI_TB_SCOREBOARD_HPP

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "tb/engine.hpp"

namespace hemi::tb {

/// The first difference: earliest ADC sample, and of the blocks that differ there the earliest in the data's
/// order.
struct Mismatch {
  config::TapIndex tap;
  std::uint64_t sample;   ///< ADC sample (telemetry: record) after which the word came out, from 0
  std::uint64_t ordinal;  ///< number of the word within its tap, from 0
  std::optional<std::int64_t> first;  ///< raw words of the two engines; none where one has sent nothing
  std::optional<std::int64_t> second;
  std::array<std::optional<std::int64_t>, config::tap_count>
      state;  ///< last words on which both agreed before it

  /// Block, sample, both values in units and in hex, and the state that led to it; several lines.
  std::string report(const std::string& first_name, const std::string& second_name) const;
};

/// Compares word by word what two engines send to its two sinks, whatever the order between different taps.
class Scoreboard {
 public:
  /// `decimation` of the instrument, ADC samples a tick; 0 for telemetry, where taps are counted in records.
  explicit Scoreboard(int decimation);

  TapSink& first() { return sides_[0]; }
  TapSink& second() { return sides_[1]; }

  /// Compares what has arrived at both sides; call it now and then to keep memory bounded.
  void compare();
  /// After both engines are idle: compare(), and a word that only one side has sent is a difference.
  void finish();

  /// The first difference so far; final once both engines have passed its sample.
  const std::optional<Mismatch>& mismatch() const { return mismatch_; }
  std::uint64_t compared() const { return compared_; }

 private:
  struct Side : TapSink {
    std::array<std::deque<std::int64_t>, config::tap_count> words;
    void tap(config::TapIndex index, std::int64_t raw) override { words[index].push_back(raw); }
  };

  std::uint64_t sample_of(config::TapIndex tap, std::uint64_t ordinal) const;
  void scan(config::TapIndex tap);
  void note(config::TapIndex tap, std::uint64_t ordinal, std::optional<std::int64_t> first,
            std::optional<std::int64_t> second);
  void take_state();
  void drop_compared(config::TapIndex tap);

  int decimation_;
  std::array<Side, 2> sides_;
  std::array<std::uint64_t, config::tap_count> ordinal_{};             ///< of the first word in the queues
  std::array<std::optional<std::int64_t>, config::tap_count> agreed_;  ///< the word before it
  std::optional<Mismatch> mismatch_;
  std::uint64_t compared_ = 0;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_SCOREBOARD_HPP

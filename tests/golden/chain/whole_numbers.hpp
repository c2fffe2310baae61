// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "golden/chain/chain.hpp"

namespace hemi::golden::testing {

/// docs/chain.md in whole numbers, statement by statement: integrators and combs, accumulators and
/// differences, 64-bit words. Slow and plain; what the quantised chain, which is written from the equations,
/// is held against.
class WholeNumbers {
 public:
  using Word = std::int64_t;

  WholeNumbers(const InstrumentParameters& instrument, const RegisterValues& values);
  std::array<Word, 3> sample(Word x, Word y, bool gap);  ///< raw DAC words: drive, rebalance, quadrature
  void telemetry(Word frequency, Word rate, bool valid);

  std::vector<Word> taps;          ///< raw words in the order in which Chain emits them
  std::set<std::string> branches;  ///< of start_up and the actuator loops, as far as taken

 private:
  struct Comb {
    std::array<Word, 5> s{};
    std::array<Word, 5> d{};
    std::array<Word, 5> u{};
  };

  struct Controller {
    config::RegisterIndex proportional, integral, limit;
    Word start;
    config::StatusBit saturated;
    const char* name;
    Word sum = 0, command = 0;
  };
  enum Mode { off, hold, proportional, closed };

  void tick();
  void start_up(Word amplitude);
  void search();
  void restart();
  void actuate(Word amplitude, Word in_phase, Word quadrature);
  void control(Controller& controller, Mode mode, Word error);
  void modulate();
  static Word dac_word(Word value, Word& error);
  std::array<Word, 2> detect(Word i, Word q);
  void loop(Word amplitude, Word phase_error);
  Word track(Word phase_error);
  void output();
  void finish(Word frequency, Word rate, bool good);
  Word sine(Word angle) const;
  Word nco_sine(Word turns) const { return sine((turns >> 24) & 0xffffff); }
  Word saturate(Word value, const config::Format& format, config::StatusBit bit);
  void raise(config::StatusBit bit, bool condition) {
    if (condition) live_ |= Word{1} << bit;
  }

  InstrumentParameters instrument_;
  std::array<Word, config::register_count> r_;
  int cic_bits_;
  std::vector<Word> base_;
  std::vector<Word> arctangent_;

  Word phase_ = 0, increment_, pending_, integral_;
  Word state_ = config::state_search, search_count_ = 0, holdover_count_ = 0, search_offset_ = 0;
  std::array<Controller, 3> loops_;
  Word drive_ = 0;  // what comes out of the amplitude loop and the search
  Word drive_now_ = 0, rebalance_now_ = 0, offset_now_ = 0, quadrature_now_ = 0;
  Word offset_ = 0, dac_quadrature_ = 0;
  Word drive_error_ = 0, rebalance_error_ = 0, quadrature_error_ = 0;
  std::array<Comb, 4> combs_;
  Word last_error_ = 0, counter_ = 0;
  bool locked_ = false;
  Word last_p_ = 0, last_tick_phase_ = 0, total_ = 0, sum_ = 0, last_sum_ = 0;
  std::array<Word, 5> c_{};
  Word r1_ = 0, r2_ = 0, e1_ = 0, e2_ = 0;
  int samples_ = 0, ticks_ = 0, outputs_ = 0;
  std::array<Word, 16> b_{};
  Word block_sum_ = 0, count_ = 0, fill_ = 0, slope_sum_ = 0, derivative_ = 0;
  Word live_ = 0, sticky_ = 0;
  bool armed_ = false;
};

}  // namespace hemi::golden::testing

// SPDX-License-Identifier: Apache-2.0
// The closed loops' part of docs/chain.md in whole numbers.
#include <algorithm>

#include "tests/golden/chain/whole_numbers.hpp"

namespace hemi::golden::testing {

using namespace config;
using Word = WholeNumbers::Word;

namespace {

Word wrap(Word value, const Format& format) {
  const int unused = 64 - format.width;
  return static_cast<Word>(static_cast<std::uint64_t>(value) << unused) >> unused;
}
Word round(Word value, int drop) {
  return drop == 0 ? value : (value + (Word{1} << (drop - 1))) >> drop;
}
Word clip(Word value, const Format& format) {
  const Word limit = Word{1} << (format.width - 1);
  return std::clamp(value, -limit, limit - 1);
}

}  // namespace

void WholeNumbers::restart() {
  integral_ = pending_ = wrap(r_[reg_nco_start] + search_offset_, increment);
  counter_ = 0;
  locked_ = false;
}

void WholeNumbers::search() {
  if (++search_count_ < r_[reg_search_ticks]) return;
  search_count_ = 0;
  search_offset_ = wrap(search_offset_ + r_[reg_search_step], increment);
  branches.insert("search: step");
  if (search_offset_ > r_[reg_search_span]) {
    search_offset_ = -r_[reg_search_span];
    branches.insert("search: sweep starts again");
  }
  restart();
}

void WholeNumbers::start_up(Word amplitude) {
  static constexpr std::array<const char*, 5> kNames = {"open", "search", "acquire", "rise", "run"};
  const bool low = amplitude < r_[reg_amplitude_threshold];
  const Word before = state_;
  if ((r_[reg_control] & 1) == 0) {
    state_ = state_open;
  } else if (before == state_open || before == state_search) {
    state_ = state_search;
    if (amplitude >= r_[reg_search_amplitude]) {
      state_ = state_acquire;
    } else {
      search();
    }
  } else if (before == state_acquire) {
    if (low) {
      state_ = state_search;
    } else if (locked_) {
      state_ = state_rise;
    }
  } else if (low) {
    if (++holdover_count_ >= r_[reg_holdover_ticks]) {
      state_ = state_search;
      holdover_count_ = search_count_ = search_offset_ = 0;
      restart();
    }
  } else {
    branches.insert(holdover_count_ > 0 ? "hold-over: over" : "hold-over: none");
    holdover_count_ = 0;
    if (!locked_) {
      state_ = state_acquire;
    } else if (amplitude >= r_[reg_closing_amplitude]) {
      state_ = state_run;
    }
  }
  const auto name = [](Word state) { return std::string(kNames[static_cast<std::size_t>(state)]); };
  branches.insert(name(before) + " to " + name(state_) + (low ? ", low" : ""));
  raise(status_searching, state_ == state_search);
  raise(status_starting, state_ == state_search || state_ == state_acquire || state_ == state_rise);
}

void WholeNumbers::control(Controller& c, Mode mode, Word error) {
  const auto seen = [this, &c](const char* what) { branches.insert(std::string(c.name) + ": " + what); };
  if (mode == off) {
    seen("off");
    c.sum = c.start * 1024;
    c.command = 0;
    return;
  }
  if (mode == hold) {
    seen("hold");
    c.command = c.sum >> 10;
    return;
  }
  seen(mode == proportional ? "proportional" : "closed");
  const auto part = [&](RegisterIndex gain) {
    const Word exact = round(error * r_[gain], 27 + registers[gain].format.fraction - 40);
    const Word clipped = clip(exact, command_integral);
    if (clipped != exact) seen(gain == c.proportional ? "proportional part clips" : "step clips");
    return clipped;
  };
  const Word limit = r_[c.limit] * 1024;
  const Word p = part(c.proportional);
  const Word i = mode == proportional ? 0 : part(c.integral);
  const Word u = c.sum + p + i;
  const bool high = u > limit;
  const bool low = u < -limit;
  raise(c.saturated, high || low);
  if ((high && i >= 0) || (low && i < 0)) {
    seen(high ? "high, holds" : "low, holds");
  } else {
    if (high || low) seen(high ? "high, comes back" : "low, comes back");
    const Word sum = c.sum + i;
    if (sum > limit) seen("integral cut above");
    if (sum < -limit) seen("integral cut below");
    c.sum = std::min(std::max(sum, -limit), limit);
  }
  const Word command = c.sum + p;
  if (command > limit) seen("command cut above");
  if (command < -limit) seen("command cut below");
  c.command = std::min(std::max(command, -limit), limit) >> 10;
}

void WholeNumbers::actuate(Word amplitude, Word in_phase, Word quadrature) {
  const bool low = amplitude < r_[reg_amplitude_threshold];
  std::array<Mode, 3> modes = {off, off, off};
  if (state_ == state_rise) modes = low ? std::array{hold, off, hold} : std::array{proportional, off, closed};
  if (state_ == state_run) modes = low ? std::array{hold, hold, hold} : std::array{closed, closed, closed};
  const Word wide_error = round(r_[reg_amplitude_setpoint] - amplitude, 5);
  const std::array<Word, 3> errors = {clip(wide_error, baseband), quadrature, clip(-in_phase, baseband)};
  if (errors[0] != wide_error) branches.insert("amplitude: error clips");
  if (errors[2] != -in_phase) branches.insert("rebalance: error clips");
  for (std::size_t k = 0; k < 3; ++k) control(loops_[k], modes[k], errors[k]);
  drive_ = state_ == state_search ? r_[reg_drive_limit] : loops_[0].command;
}

void WholeNumbers::modulate() {
  const Word m = pending_ >> 17;
  offset_ = wrap(r_[reg_modulation_phase] + round(m * r_[reg_modulation_delay], 31 + 18 - 32), angle);
  dac_quadrature_ = dac_word(loops_[1].command, quadrature_error_);
}

Word WholeNumbers::dac_word(Word value, Word& error) {
  const Word s = value + error;
  const Word word = clip(round(s, 15), dac);
  error = word == round(s, 15) ? s - word * 32768 : 0;
  return word;
}

}  // namespace hemi::golden::testing

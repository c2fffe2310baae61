// SPDX-License-Identifier: Apache-2.0
#include "tb/scoreboard.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tb/registers.hpp"

namespace hemi::tb {
namespace {

std::string word_text(config::TapIndex index, std::optional<std::int64_t> word) {
  if (!word) return "nothing";
  const std::int64_t raw = *word;
  const config::Tap& tap = config::taps[index];
  const std::uint64_t mask = (std::uint64_t{1} << tap.format.width) - 1;
  return fmt::format("{} {} (0x{:0{}x})", to_value(raw, tap.format), tap.unit,
                     static_cast<std::uint64_t>(raw) & mask, (tap.format.width + 3) / 4);
}

}  // namespace

std::string Mismatch::report(const std::string& first_name, const std::string& second_name) const {
  const config::Tap& where = config::taps[tap];
  std::string text = fmt::format("first difference at sample {} in block {}, word {} number {}\n", sample,
                                 where.block, where.name, ordinal);
  text += fmt::format("  {:<8} {}\n", first_name, word_text(tap, first));
  text += fmt::format("  {:<8} {}\n", second_name, word_text(tap, second));
  text += "  state before it, equal in both:\n";
  for (int i = 0; i < config::tap_count; ++i) {
    if (!state[i]) continue;
    const auto index = static_cast<config::TapIndex>(i);
    text += fmt::format("    {:<22} {:<22} {}\n", config::taps[i].block, config::taps[i].name,
                        word_text(index, state[i]));
  }
  return text;
}

Scoreboard::Scoreboard(int decimation) : decimation_(decimation) {}

std::uint64_t Scoreboard::sample_of(config::TapIndex tap, std::uint64_t ordinal) const {
  if (decimation_ == 0) return ordinal;
  const auto r = static_cast<std::uint64_t>(decimation_);
  switch (config::taps[tap].rate) {
    case config::TapRate::sample:
      return ordinal;
    case config::TapRate::tick:
      return (ordinal + 1) * r - 1;
    default:
      return (ordinal + 1) * r * config::ticks_per_output - 1;
  }
}

void Scoreboard::note(config::TapIndex tap, std::uint64_t ordinal, std::optional<std::int64_t> first,
                      std::optional<std::int64_t> second) {
  const std::uint64_t sample = sample_of(tap, ordinal);
  if (mismatch_ && (mismatch_->sample < sample || (mismatch_->sample == sample && mismatch_->tap <= tap)))
    return;
  mismatch_ = Mismatch{tap, sample, ordinal, first, second, {}};
  take_state();
}

void Scoreboard::scan(config::TapIndex tap) {
  const auto& a = sides_[0].words[tap];
  const auto& b = sides_[1].words[tap];
  const std::size_t n = std::min(a.size(), b.size());
  compared_ += n;
  for (std::size_t i = 0; i < n; ++i) {
    if (a[i] == b[i]) continue;
    note(tap, ordinal_[tap] + i, a[i], b[i]);
    return;
  }
}

void Scoreboard::take_state() {
  for (int i = 0; i < config::tap_count; ++i) {
    const auto tap = static_cast<config::TapIndex>(i);
    std::optional<std::int64_t> last = agreed_[i];
    const auto& words = sides_[0].words[i];
    for (std::size_t k = 0; k < words.size() && sample_of(tap, ordinal_[i] + k) < mismatch_->sample; ++k)
      last = words[k];
    mismatch_->state[i] = last;
  }
}

void Scoreboard::drop_compared(config::TapIndex tap) {
  auto& a = sides_[0].words[tap];
  auto& b = sides_[1].words[tap];
  const auto n = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
  if (n == 0) return;
  agreed_[tap] = a[static_cast<std::size_t>(n - 1)];
  a.erase(a.begin(), a.begin() + n);
  b.erase(b.begin(), b.begin() + n);
  ordinal_[tap] += static_cast<std::uint64_t>(n);
}

void Scoreboard::compare() {
  for (int i = 0; i < config::tap_count; ++i) scan(static_cast<config::TapIndex>(i));
  for (int i = 0; i < config::tap_count; ++i) drop_compared(static_cast<config::TapIndex>(i));
}

void Scoreboard::finish() {
  compare();
  for (int i = 0; i < config::tap_count; ++i) {
    const auto tap = static_cast<config::TapIndex>(i);
    const auto& a = sides_[0].words[i];
    const auto& b = sides_[1].words[i];
    if (!a.empty()) note(tap, ordinal_[i], a.front(), std::nullopt);
    if (!b.empty()) note(tap, ordinal_[i], std::nullopt, b.front());
  }
}

}  // namespace hemi::tb

// SPDX-License-Identifier: Apache-2.0
#include "rtl/microcode/schedule.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>

#include "rtl/microcode/allocate.hpp"
#include "rtl/microcode/dependence.hpp"

namespace hemi::microcode {
namespace {

Instruction idle_place(const char* block) {
  Instruction nothing;
  nothing.condition = Condition::never;
  nothing.block = block;
  return nothing;
}

/// Orders one region's lines: at each clock the ready line with the longest way to the end; in the background
/// lines that stand first in the text count for more, which shortens the lives of words.
class ListScheduler {
 public:
  /// `late_words` and `early_words`: written and read by samples.
  ListScheduler(const Region& region, Word nowhere, const std::set<int>& late_words,
                const std::set<int>& early_words)
      : lines_(region.lines.begin(), region.lines.end()),
        nowhere_(nowhere),
        in_text_order_(region.background),
        placed_(lines_.size(), -1),
        height_(lines_.size(), 0),
        earliest_(lines_.size(), 0) {
    for (std::size_t i = lines_.size(); i-- > 0;) {
      height_[i] = result_latency(lines_[i]);
      for (std::size_t j = i + 1; j < lines_.size(); ++j) {
        const int d =
            exact(i) && j == i + 1 ? result_latency(lines_[i]) : distance(lines_[i], lines_[j], nowhere_);
        if (d > 0) height_[i] = std::max(height_[i], d + height_[j]);
      }
      const bool late = (reads_a(lines_[i]) && late_words.count(lines_[i].a.address) > 0) ||
                        (reads_b(lines_[i]) && late_words.count(lines_[i].b.address) > 0);
      if (!region.follows_sample) continue;
      if (late) earliest_[i] = latency::word - 1;
      const bool early = writes(lines_[i], nowhere) && early_words.count(lines_[i].dst.address) > 0;
      if (late || early) height_[i] += urgent;  // no sample may go first before these are done
    }
  }

  /// Clock of each line.
  const std::vector<int>& run() {
    std::size_t left = lines_.size();
    for (int clock = 0; left > 0; ++clock) {
      if (taken_.count(clock) > 0) continue;
      std::optional<std::size_t> best;
      for (std::size_t i = 0; i < lines_.size(); ++i) {
        if (follows_exactly(i) || !ready(i, clock)) continue;
        if (!best || weight(i) > weight(*best)) best = i;
      }
      if (!best) continue;
      left -= place(*best, clock);
    }
    return placed_;
  }

 private:
  static constexpr int urgent = 1000;

  int weight(std::size_t i) const { return 2 * height_[i] - (in_text_order_ ? static_cast<int>(i) : 0); }
  bool exact(std::size_t i) const { return result_latency(lines_[i]) > 0; }
  bool follows_exactly(std::size_t i) const { return i > 0 && exact(i - 1); }

  bool operands_ready(std::size_t i, int clock, std::size_t except) const {
    for (std::size_t j = 0; j < i; ++j) {
      if (j == except) continue;
      const int d = distance(lines_[j], lines_[i], nowhere_);
      if (d > 0 && (placed_[j] < 0 || placed_[j] + d > clock)) return false;
    }
    return clock >= earliest_[i];
  }

  bool ready(std::size_t i, int clock) const {
    if (placed_[i] >= 0 || !operands_ready(i, clock, i)) return false;
    if (!exact(i)) return true;
    const int use = clock + result_latency(lines_[i]);
    return taken_.count(use) == 0 && operands_ready(i + 1, use, i);
  }

  std::size_t place(std::size_t i, int clock) {
    placed_[i] = clock;
    taken_.insert(clock);
    if (!exact(i)) return 1;
    placed_[i + 1] = clock + result_latency(lines_[i]);
    taken_.insert(placed_[i + 1]);
    return 2;
  }

  std::vector<Instruction> lines_;
  Word nowhere_;
  bool in_text_order_;
  std::vector<int> placed_;
  std::vector<int> height_;
  std::vector<int> earliest_;
  std::set<int> taken_;
};

/// One region with its clocks, before it gets its address.
struct Placed {
  std::vector<Instruction> places;
  std::vector<bool> may_yield;
};

class Placer {
 public:
  explicit Placer(const Assembler& m) : m_(m), nowhere_(m.words().at("nowhere")) {
    for (const Region& region : m.regions()) {
      if (region.last != Control::give_back) continue;
      for (const Instruction& i : region.lines) {
        sample_reads_.insert(i.a.address);
        sample_reads_.insert(i.b.address);
        if (writes(i, nowhere_)) sample_writes_.insert(i.dst.address);
      }
    }
    sample_reads_.insert(dac_quadrature_port.address);  // goes out with the sample's other words
  }

  Placed place(const Region& region) const {
    const std::vector<Instruction> lines(region.lines.begin(), region.lines.end());
    std::vector<int> clocks(lines.size());
    if (region.in_order) {
      for (std::size_t i = 0; i < lines.size(); ++i) clocks[i] = static_cast<int>(i);
    } else {
      clocks = ListScheduler(region, nowhere_, sample_writes_, sample_reads_).run();
    }
    int length = 1 + *std::max_element(clocks.begin(), clocks.end());
    if (!ends_itself(region)) length += settling(region);
    Placed placed;
    placed.places.assign(length, idle_place(lines.back().block));
    for (std::size_t i = 0; i < lines.size(); ++i) placed.places[clocks[i]] = lines[i];
    placed.may_yield.assign(length, region.background && !region.in_order);
    forbid_yields(region, lines, clocks, placed.may_yield);
    finish(region, placed);
    return placed;
  }

 private:
  static bool ends_itself(const Region& region) { return region.last != Control::next; }
  /// The next region may use all words, and a jump the sign, when it begins; the jump has a place of its own.
  static int settling(const Region& region) {
    return region.jump_target.empty() ? latency::word - 1 : std::max(latency::word - 1, latency::jump);
  }

  /// A sample may not come between a product and its use, nor before the words it shares are read and
  /// written.
  void forbid_yields(const Region& region, const std::vector<Instruction>& lines,
                     const std::vector<int>& clocks, std::vector<bool>& may_yield) const {
    const auto forbid = [&](int from, int to) {
      for (int t = std::max(from, 0); t < to; ++t) may_yield[t] = false;
    };
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const int clock = clocks[i];
      if (result_latency(lines[i]) > 0) forbid(clock, clock + result_latency(lines[i]));
      if (lines[i].control != Control::next) may_yield[clock] = false;
      if (!region.follows_sample) continue;
      if ((reads_a(lines[i]) && sample_writes_.count(lines[i].a.address) > 0) ||
          (reads_b(lines[i]) && sample_writes_.count(lines[i].b.address) > 0)) {
        forbid(0, clock);
      }
      if (writes(lines[i], nowhere_) && sample_reads_.count(lines[i].dst.address) > 0) {
        forbid(0, clock + latency::word - 1);
      }
    }
  }

  void finish(const Region& region, Placed& placed) const {
    Instruction& last = placed.places.back();
    if (ends_itself(region)) {
      if (last.control != Control::next)
        throw std::logic_error("last place of " + region.label + " is taken");
      last.control = region.last;
    }
    if (region.jump_target.empty()) return;
    last.control = Control::jump;
    last.target = region.jump_target;
    last.condition = region.jump_condition;
    last.operation = Operation::add;
    placed.may_yield.back() = false;
  }

  const Assembler& m_;
  Word nowhere_;
  std::set<int> sample_reads_;
  std::set<int> sample_writes_;
};

/// Puts yields as late as the slice allows, and one near the end, so that the next region starts afresh.
int place_yields(const std::string& label, Placed& placed, int slice) {
  const int length = static_cast<int>(placed.places.size());
  int longest = 0;
  int begin = 0;  // first place of the slice
  while (begin < length) {
    int end = std::min(begin + slice, length) - 1;
    while (end >= begin && !placed.may_yield[end]) --end;
    if (end < begin) {
      if (begin > 0 && length - begin <= latency::word) break;  // the jump alone: begins the next slice
      throw std::logic_error("no place to yield in " + label + " behind clock " + std::to_string(begin));
    }
    placed.places[end].control = Control::yield;
    longest = std::max(longest, end + 1 - begin);
    begin = end + 1;
  }
  return std::max(longest + 1, length - begin);
}

void check_words(const Assembler& m) {
  const Word nowhere = m.words().at("nowhere");
  for (const auto& [name, word] : m.words()) {
    if (word == nowhere) continue;
    bool read = false;
    bool written = false;
    for (const Region& region : m.regions()) {
      for (const Instruction& i : region.lines) {
        read = read || reads(i, word);
        written = written || (writes(i, nowhere) && i.dst == word);
      }
    }
    if (!read || !written) throw std::logic_error(name + (read ? " is never written" : " is never read"));
  }
}

void check_lengths(const Assembler& m, const Schedule& s) {
  const int sample = s.clocks.at("sample");
  if (sample + s.longest_slice > clocks_per_sample) throw std::logic_error("a slice is too long");
  constexpr int clocks_per_word = 8;  // a record word through the machine and out
  const int background = s.clocks.at("tick") + s.clocks.at("output") + s.clocks.at("finish") +
                         s.clocks.at("block") + s.clocks.at("settle") +
                         config::record_words * clocks_per_word;
  // At the slowest clock each sample of the next tick leaves so much to the background of this one.
  const int room = (m.instrument().decimation - 1) * (clocks_per_sample - sample);
  if (background > room)
    throw std::logic_error("the work of a tick and an output does not fit their samples");
}

}  // namespace

Schedule schedule(const Assembler& m) {
  check_words(m);
  const Placer placer(m);
  Schedule s;
  std::vector<Placed> all;
  for (const Region& region : m.regions()) {
    all.push_back(placer.place(region));
    s.clocks[region.label] = static_cast<int>(all.back().places.size());
  }
  const int slice = clocks_per_sample - s.clocks.at("sample") - latency::word;
  for (std::size_t r = 0; r < all.size(); ++r) {
    const Region& region = m.regions()[r];
    s.entries[region.label] = static_cast<int>(s.program.size());
    if (region.background && !region.in_order) {
      s.longest_slice = std::max(s.longest_slice, place_yields(region.label, all[r], slice));
    }
    s.program.insert(s.program.end(), all[r].places.begin(), all[r].places.end());
  }
  check_lengths(m, s);
  allocate(m, s);
  return s;
}

}  // namespace hemi::microcode

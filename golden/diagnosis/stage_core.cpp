// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/stage_core.hpp"

#include <algorithm>
#include <cmath>

namespace hemi::diagnosis {
namespace {

using namespace config;

constexpr std::size_t kRecordsOfATrial = 60;  // after the first difference
constexpr int kNewtonSteps = 12;

using Differs = std::array<bool, record_words>;

struct Difference {
  std::size_t compared = 0, differing = 0;
  Differs differs{}, at_first{};
  std::optional<std::size_t> first;
};

/// A register that was upset while the core ran raises the parity bit; a replay with that value does not.
double without_parity(double status) {
  const std::uint64_t bit = std::uint64_t{1} << status_parity_error;
  return static_cast<double>(static_cast<std::uint64_t>(status) & ~(bit | bit << status_shift));
}

bool differ(std::size_t word, double recorded, double replayed, double tolerance) {
  if (word == word_status) return without_parity(recorded) != without_parity(replayed);
  return !(std::abs(recorded - replayed) <= tolerance);
}

Difference difference(const RecordedWords& recorded, const std::vector<CoreWords>& replayed) {
  Difference d;
  for (std::size_t i = 0; i < std::min(recorded.records.size(), replayed.size()); ++i) {
    for (std::size_t w = 0; w < record_words; ++w) {
      const double value = recorded.records[i][w];
      if (std::isnan(value)) continue;
      ++d.compared;
      if (!differ(w, value, replayed[i][w], recorded.tolerance[w])) continue;
      ++d.differing;
      if (!d.first) d.first = i;
      d.differs[w] = true;
      if (*d.first == i) d.at_first[w] = true;
    }
  }
  return d;
}

std::string earliest_block(const Differs& first, const Differs& ever) {
  if (ever[word_amplitude])
    return "nco, demodulator, cic, image_filter, phase_detector or reference_phase_loop";
  if (ever[word_phase_error]) return "reference_phase_loop";
  if (ever[word_frequency]) return "frequency_tracker";
  if (ever[word_quadrature] && ever[word_rate]) return "phase_detector";
  if (first[word_drive]) return "amplitude_loop";
  if (first[word_quadrature]) return "quadrature_loop";
  if (ever[word_rate]) return "rebalance_loop or rate_filter";
  if (ever[word_drive]) return "amplitude_loop";
  if (ever[word_quadrature]) return "quadrature_loop";
  if (ever[word_temperature]) return "thermometer";
  if (ever[word_derivative]) return "derivative";
  if (ever[word_bias] || ever[word_compensated]) return "derivative or bias_model";
  return "status";
}

double step_of(const Register& about, double value) {
  const double lsb = std::ldexp(1.0, -about.format.fraction);
  return std::max(std::abs(value) * 1e-3, lsb * (about.format.fraction == 0 ? 1.0 : 256.0));
}

double rounded(const Register& about, double value) {
  return std::ldexp(std::floor(std::ldexp(value, about.format.fraction) + 0.5), -about.format.fraction);
}

/// One number that some registers depend on.
class WordSearch {
 public:
  WordSearch(const RecordedWords& recorded, const Replay& replay, std::size_t first)
      : recorded_(recorded),
        replay_(replay),
        first_(first),
        records_(std::min(recorded.records.size(), first + kRecordsOfATrial)) {}

  std::vector<CoreWords> trial(const CoreRegisters& registers) const {
    return replay_(registers, records_ * recorded_.samples_a_record, false).records;
  }

  /// All words of the recording; soon done with a value that is wrong.
  bool explains(const CoreRegisters& registers) const {
    for (const std::size_t records : {std::min(first_ + 3, records_), records_}) {
      const auto run = replay_(registers, records * recorded_.samples_a_record, false).records;
      if (run.size() < records || difference(recorded_, run).differing > 0) return false;
    }
    const auto whole =
        replay_(registers, recorded_.records.size() * recorded_.samples_a_record, false).records;
    return difference(recorded_, whole).differing == 0;
  }

  /// Words of equal standing: each difference over the rms of what has to be explained.
  void weigh(const std::vector<CoreWords>& nominal) {
    for (std::size_t w = 0; w < record_words; ++w) {
      double squares = 0.0;
      for (std::size_t i = 0; i < records_; ++i) {
        const double d = recorded_.records[i][w] - nominal[i][w];
        if (w != word_status && std::isfinite(d)) squares += d * d;
      }
      weight_[w] = squares > 0.0 ? 1.0 / squares : 0.0;
    }
  }

  double misfit(const std::vector<CoreWords>& words) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < records_; ++i) {
      for (std::size_t w = 0; w < record_words; ++w) {
        const double d = recorded_.records[i][w] - words[i][w];
        if (std::isfinite(d)) sum += weight_[w] * d * d;
      }
    }
    return sum;
  }

  /// Newton's step from `at` by differences: (value of the step, squares of the sensitivity).
  std::pair<double, double> newton(const std::vector<CoreWords>& at, const std::vector<CoreWords>& moved,
                                   double by) const {
    double product = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < records_; ++i) {
      for (std::size_t w = 0; w < record_words; ++w) {
        const double s = (moved[i][w] - at[i][w]) / by, d = recorded_.records[i][w] - at[i][w];
        if (!std::isfinite(d) || !std::isfinite(s)) continue;
        product += weight_[w] * s * d;
        squares += weight_[w] * s * s;
      }
    }
    return {squares > 0.0 ? product / squares : 0.0, squares};
  }

  std::size_t records() const { return records_; }

 private:
  const RecordedWords& recorded_;
  const Replay& replay_;
  std::size_t first_;
  std::size_t records_;
  CoreWords weight_{};
};

bool covers(const Differs& possible, const Differs& seen) {
  for (std::size_t w = 0; w < record_words; ++w)
    if (seen[w] && !possible[w] && w != word_status) return false;
  return true;
}

// Which words a change from `nominal` to `moved` reaches.
Differs reach(const std::vector<CoreWords>& nominal, const std::vector<CoreWords>& moved) {
  Differs reached{};
  for (std::size_t i = 0; i < std::min(nominal.size(), moved.size()); ++i)
    for (std::size_t w = 0; w < record_words; ++w) reached[w] = reached[w] || nominal[i][w] != moved[i][w];
  return reached;
}

/// Value at which `set(value)` explains the recording, by Newton's steps with halving from the best of
/// `starts` (loops at their limits make other minima), or nothing.
std::optional<double> solve(const WordSearch& search, const std::vector<double>& starts, double step,
                            double resolution, const std::function<CoreRegisters(double)>& set,
                            const std::function<bool(double)>& accept) {
  double value = starts.front();
  auto at = search.trial(set(value));
  double misfit = search.misfit(at);
  for (const double start : starts) {
    auto trial = search.trial(set(start));
    if (trial.size() < search.records() || !(search.misfit(trial) < misfit)) continue;
    value = start;
    at = std::move(trial);
    misfit = search.misfit(at);
  }
  double last = std::abs(step);
  for (int k = 0; k < kNewtonSteps; ++k) {
    const auto moved = search.trial(set(value + step));
    if (moved.size() < search.records()) return std::nullopt;
    double change = search.newton(at, moved, step).first;
    bool better = false;
    for (int half = 0; half < 6 && !better; ++half, change *= 0.5) {
      const auto next = search.trial(set(value + change));
      if (next.size() < search.records()) continue;
      const double next_misfit = search.misfit(next);
      if (!(next_misfit < misfit)) continue;
      better = true;
      value += change;
      at = next;
      misfit = next_misfit;
    }
    if (misfit == 0.0 || !better) break;
    last = std::abs(change);
    step = std::max(std::abs(change) * 0.25, std::abs(step) * 1e-3);
  }
  // Where a limit is reached at one more sample the slope says nothing of the next step: close in by halves.
  constexpr double promising = 0.05;
  const double unexplained = search.misfit(search.trial(set(starts.front())));
  for (double reach = last; misfit > 0.0 && misfit < promising * unexplained && reach > 0.25 * resolution;) {
    bool better = false;
    for (const double to : {value + reach, value - reach}) {
      const auto trial = search.trial(set(to));
      if (trial.size() < search.records() || !(search.misfit(trial) < misfit)) continue;
      misfit = search.misfit(trial);
      value = to;
      better = true;
      break;
    }
    if (!better) reach *= 0.5;
  }
  if (accept(value)) return value;
  return std::nullopt;
}

void try_demodulation(const WordSearch& search, const CoreRegisters& nominal, CoreComparison& result) {
  const auto turned = [&](double rad) {
    CoreRegisters registers = nominal;
    const double c = nominal[reg_demodulation_cos], s = nominal[reg_demodulation_sin];
    registers[reg_demodulation_cos] = c * std::cos(rad) - s * std::sin(rad);
    registers[reg_demodulation_sin] = s * std::cos(rad) + c * std::sin(rad);
    return registers;
  };
  const double lsb = std::ldexp(1.0, -registers[reg_demodulation_sin].format.fraction);
  double found = 0.0;
  const double unexplained = search.misfit(search.trial(nominal));
  const auto accept = [&](double rad) {
    // Two rounded registers from one number: where the last bit of one is open, a millionth may stay.
    if (search.misfit(search.trial(turned(rad))) < 1e-6 * unexplained) found = rad;
    for (const double off : {0.0, 0.3, -0.3, 0.6, -0.6, 1.0, -1.0}) {
      if (!search.explains(turned(rad + off * lsb))) continue;
      found = rad + off * lsb;
      break;
    }
    return found != 0.0;
  };
  constexpr double starts_rad[] = {0.0,   1e-3, 2e-3, 4e-3, 8e-3, 0.016, 0.032,
                                   0.065, 0.13, 0.3,  0.7,  1.5,  3.0};
  std::vector<double> starts;
  for (const double rad : starts_rad) starts.insert(starts.end(), {rad, -rad});
  if (!solve(search, starts, 1e-4, lsb, turned, accept)) return;
  result.demodulation_rad = found;
  result.explaining = turned(found);
}

void try_register(const WordSearch& search, const CoreRegisters& nominal, RegisterIndex index,
                  CoreComparison& result) {
  const Register& about = registers[index];
  const auto with = [&](double value) {
    CoreRegisters changed = nominal;
    changed[index] = value;
    return changed;
  };
  const double lsb = std::ldexp(1.0, -about.format.fraction), raw_nominal = rounded(about, nominal[index]);
  double found = raw_nominal;
  const auto accept = [&](double value) {
    for (const double off : {0.0, 1.0, -1.0, 2.0, -2.0}) {
      found = rounded(about, value) + off * lsb;
      if (found != raw_nominal && search.explains(with(found))) return true;
    }
    return false;
  };
  std::vector<double> starts = {nominal[index]};
  for (const double change : {1e-2, 5e-2, 0.2})
    starts.insert(starts.end(), {nominal[index] * (1.0 + change), nominal[index] * (1.0 - change)});
  bool explained = solve(search, starts, step_of(about, nominal[index]), lsb, with, accept).has_value();
  // A flipped bit may be far from where the words are smooth in the register.
  for (int bit = 0; bit < about.format.width && !explained; ++bit) {
    const auto raw = static_cast<std::int64_t>(std::ldexp(raw_nominal, about.format.fraction));
    const std::int64_t limit = std::int64_t{1} << (about.format.width - 1);
    std::int64_t flipped = raw ^ (std::int64_t{1} << bit);
    if (bit == about.format.width - 1) flipped = raw < 0 ? raw + limit : raw - limit;
    found = std::ldexp(static_cast<double>(flipped), -about.format.fraction);
    explained = search.explains(with(found));
  }
  if (!explained) return;
  if (!result.explained()) result.explaining = with(found);
  result.registers.push_back({index, nominal[index], found});
}

}  // namespace

CoreComparison compare_core(const RecordedWords& recorded, const CoreRegisters& nominal,
                            const Replay& replay) {
  CoreComparison result;
  result.explaining = nominal;
  const auto replayed = replay(nominal, recorded.records.size() * recorded.samples_a_record, false).records;
  const Difference all = difference(recorded, replayed);
  result.compared = all.compared;
  result.differing = all.differing;
  result.differs = all.differs;
  result.first_record = all.first;
  if (!all.first) return result;
  result.block = earliest_block(all.at_first, all.differs);
  WordSearch search(recorded, replay, *all.first);
  const auto at = search.trial(nominal);
  search.weigh(at);
  // A phase is the simpler explanation where both registers of it are wrong.
  if (all.differs[word_rate] || all.differs[word_quadrature]) try_demodulation(search, nominal, result);
  if (result.demodulation_rad) return result;
  for (int r = 0; r < register_count; ++r) {
    if (r == reg_parity) continue;
    CoreRegisters moved = nominal;
    moved[static_cast<std::size_t>(r)] += step_of(registers[r], moved[static_cast<std::size_t>(r)]);
    auto words = search.trial(moved);
    if (words.size() < search.records()) {
      moved[static_cast<std::size_t>(r)] =
          2.0 * nominal[static_cast<std::size_t>(r)] - moved[static_cast<std::size_t>(r)];
      words = search.trial(moved);
    }
    if (!covers(reach(at, words), all.differs)) continue;
    try_register(search, nominal, static_cast<RegisterIndex>(r), result);
  }
  // The sine alone is all of a small phase.
  if (result.registers.size() == 1 && result.registers[0].index == reg_demodulation_sin) {
    const double cosine = nominal[reg_demodulation_cos];
    result.demodulation_rad =
        std::atan2(result.registers[0].found, cosine) - std::atan2(result.registers[0].nominal, cosine);
  }
  return result;
}

}  // namespace hemi::diagnosis

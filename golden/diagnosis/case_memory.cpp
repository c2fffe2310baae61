// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/case_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "golden/diagnosis/series.hpp"

namespace hemi::diagnosis {
namespace {

using C = MemoryColumns;
using Index = Eigen::Index;
constexpr std::uint64_t kSeed = 1;
constexpr Index kAverages = 400;  // rows are averaged to about this many for tests with coloured noise
constexpr std::size_t kDecoys = 8;
constexpr double kLimitSigmas = 5.0;
constexpr Index kTestBlocks = 20;

std::size_t at(MemoryFamily family) {
  return static_cast<std::size_t>(family);
}

Eigen::MatrixXd averages(const Eigen::MatrixXd& rows) {
  const Index group = std::max<Index>(1, rows.rows() / kAverages);
  Eigen::MatrixXd mean(rows.rows() / group, rows.cols());
  for (Index i = 0; i < mean.rows(); ++i) mean.row(i) = rows.middleRows(i * group, group).colwise().mean();
  return mean;
}

double ljung_box_p(const Eigen::VectorXd& residual) {
  constexpr Index lags = 20;
  const Eigen::VectorXd x = residual.array() - residual.mean();
  const auto n = static_cast<double>(x.size());
  double q = 0.0;
  for (Index k = 1; k <= lags; ++k) {
    const double r = x.head(x.size() - k).dot(x.tail(x.size() - k)) / x.squaredNorm();
    q += r * r / (n - static_cast<double>(k));
  }
  const boost::math::chi_squared_distribution<double> distribution(static_cast<double>(lags));
  return boost::math::cdf(boost::math::complement(distribution, n * (n + 2.0) * q));
}

// A combination of a form's coefficients, with its interval by leaving out one block after another. Source:
// Kunsch, Annals of Statistics 17 (1989) 1217.
MemoryParameter parameter(const ChosenForm& chosen, const Eigen::VectorXd& weights, std::string name,
                          std::string unit) {
  const Eigen::VectorXd each = chosen.without_a_block.transpose() * weights;
  const auto n = static_cast<double>(each.size());
  const double variance = (n - 1.0) / n * (each.array() - each.mean()).square().sum();
  const boost::math::students_t_distribution<double> student(n - 1.0);
  return {std::move(name), std::move(unit), chosen.coefficients.dot(weights),
          boost::math::quantile(student, 0.975) * std::sqrt(variance)};
}

// Weights that pick one column; empty where the form lacks it.
Eigen::VectorXd picking(const ChosenForm& chosen, Index column, double factor) {
  const auto place = std::ranges::find(chosen.form.columns, column);
  if (place == chosen.form.columns.end()) return {};
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(chosen.coefficients.size());
  weights[place - chosen.form.columns.begin()] = factor;
  return weights;
}

std::vector<MemoryParameter> lag_parameters(const ChosenForm& chosen, const C& columns) {
  std::vector<std::pair<double, std::array<MemoryParameter, 2>>> nodes;
  for (Index k = 0; k < C::kNodes; ++k) {
    const Eigen::VectorXd pick = picking(chosen, C::lag(k), 1.0 / columns.half_degc);
    if (pick.size() == 0) continue;
    const double tau = columns.tau_s[static_cast<std::size_t>(k)];
    const MemoryParameter gain = parameter(chosen, pick, "gain", "deg/h/degC");
    nodes.push_back({std::abs(gain.value) * columns.half_degc * columns.values.col(C::lag(k)).norm(),
                     {gain, {"node_time_constant", "s", tau, 0.0}}});
  }
  // The strongest first, under the names that the catalogue gives to a single node.
  std::ranges::sort(nodes, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<MemoryParameter> list;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (MemoryParameter& each : nodes[i].second) {
      if (i > 0) each.name += fmt::format("_{}", i + 1);
      list.push_back(each);
    }
  }
  return list;
}

MemoryParameter loop_height(const ChosenForm& chosen, const C& columns) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(chosen.coefficients.size());
  for (Index k = 0; k < C::kPlays; ++k) {
    // The column is T - play, the catalogue's term w play: a rate that lags has a positive loop.
    const double opening = -2.0 * columns.threshold_degc[static_cast<std::size_t>(k)] / columns.half_degc;
    const Eigen::VectorXd pick = picking(chosen, C::play(k, 0), opening);
    if (pick.size() > 0) weights += pick;
  }
  return parameter(chosen, weights, "loop_height", "deg/h");
}

std::vector<MemoryParameter> drift_parameters(const ChosenForm& chosen, const C& columns) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(chosen.coefficients.size());
  const Index last = columns.values.rows() - 1;
  for (Index k = 0; k < C::kDrifts; ++k) {
    const double change = columns.values(last, C::drift(k, 0)) - columns.values(0, C::drift(k, 0));
    const Eigen::VectorXd pick = picking(chosen, C::drift(k, 0), change);
    if (pick.size() > 0) weights += pick;
  }
  return {parameter(chosen, weights, "total_drift", "deg/h")};
}

std::vector<MemoryParameter> pole_parameters(const ChosenForm& chosen, const C& columns) {
  const Index pair = (chosen.form.columns.back() - C::two_poles(0, 1)) / C::kCube;
  Index next = 0;
  for (Index k = 0; k < C::kNodes; ++k) {
    for (Index j = k + 1; j <= C::kNodes; ++j, ++next) {
      if (next != pair) continue;
      std::vector<MemoryParameter> list = {
          {"time_constant", "s", columns.tau_s[static_cast<std::size_t>(k)], 0.0}};
      if (j < C::kNodes)
        list.push_back({"second_time_constant", "s", columns.tau_s[static_cast<std::size_t>(j)], 0.0});
      return list;
    }
  }
  return {};
}

class Judge {
 public:
  explicit Judge(CaseMemory& result) : result_(result), selection_(result.selection) {}

  void families() {
    for (const MemoryFamily family : kMemoryFamilies)
      if (rms(selection_.held_out[at(family)]) < rms(selection_.held_out[at(result_.best)]))
        result_.best = family;
    for (const MemoryFamily family : kMemoryFamilies) {
      FamilyReport report{family, gain(MemoryFamily::polynomial, family), gain(family, result_.best), false};
      report.beaten = family != result_.best && report.to_best.low > 0.0;
      result_.families.push_back(report);
    }
  }

  void verdict() {
    const auto beaten = [&](MemoryFamily family) { return result_.families[at(family)].beaten; };
    if (!beaten(MemoryFamily::polynomial) || result_.held_out.low <= 0.0) return;
    for (const Memory memory : kMemories) {
      bool all = true, some = false;
      for (const MemoryFamily family : kMemoryFamilies) {
        if (beaten(family)) continue;
        all = all && holds(family, memory);
        some = some || holds(family, memory);
      }
      if (!some) continue;
      FoundMemory each = found(memory);
      const bool certain = all && result_.both_ways >= kBothWaysNeeded && result_.decoys_accepted == 0 &&
                           each.strength_certain();
      (certain ? result_.named : result_.open).push_back(std::move(each));
    }
    result_.verdict = result_.named.empty() ? Verdict::ambiguous : Verdict::named;
  }

 private:
  Gain gain(MemoryFamily before, MemoryFamily after) const {
    return bootstrap_gain(selection_.held_out[at(before)], selection_.held_out[at(after)], selection_.blocks,
                          kSeed);
  }

  MemoryFamily least(Memory memory, bool with) const {
    MemoryFamily least = MemoryFamily::polynomial;
    double value = std::numeric_limits<double>::infinity();
    for (const MemoryFamily family : kMemoryFamilies) {
      if (holds(family, memory) != with || !(rms(selection_.held_out[at(family)]) < value)) continue;
      value = rms(selection_.held_out[at(family)]);
      least = family;
    }
    return least;
  }

  FoundMemory found(Memory memory) const {
    const MemoryFamily with = least(memory, true), without = least(memory, false);
    std::vector<Eigen::VectorXd> others;
    for (const MemoryFamily family : kMemoryFamilies)
      if (!holds(family, memory)) others.push_back(selection_.held_out[at(family)]);
    FoundMemory result{memory,
                       share_won(selection_.held_out[at(with)], others, selection_.blocks, kSeed),
                       std::log(rms(selection_.held_out[at(without)]) / rms(selection_.held_out[at(with)])),
                       {}};
    const ChosenForm& chosen = selection_.whole.best[at(with)];
    const C& columns = selection_.columns[chosen.form.past];
    switch (memory) {
      case Memory::lag:
        result.parameters = lag_parameters(chosen, columns);
        break;
      case Memory::two_poles:
        result.parameters = pole_parameters(chosen, columns);
        break;
      case Memory::hysteresis:
        result.parameters = {loop_height(chosen, columns)};
        break;
      case Memory::drift:
        result.parameters = drift_parameters(chosen, columns);
        break;
    }
    return result;
  }

  CaseMemory& result_;
  const NestedSelection& selection_;
};

// Five standard errors of each column's coefficient beside the model that was kept, under the coloured noise
// that it leaves. A column that the model holds already has an estimate instead of a limit.
std::vector<MemoryLimit> limits_of(const NestedSelection& selection, MemoryFamily kept) {
  const ChosenForm& chosen = selection.whole.best[at(kept)];
  const C& columns = selection.columns[chosen.form.past];
  const Eigen::VectorXd residual = averages(selection.train[at(kept)]);
  const Eigen::MatrixXd model = averages(columns.values(Eigen::all, chosen.form.columns));
  std::vector<Index> tested;
  const auto add = [&](Index column) {
    if (std::ranges::find(chosen.form.columns, column) == chosen.form.columns.end()) tested.push_back(column);
  };
  for (Index k = 0; k < C::kNodes; ++k) add(C::lag(k));
  for (Index k = 0; k < C::kPlays; ++k) add(C::play(k, 0));
  add(C::drift(0, 0));
  if (tested.empty()) return {};
  const MaxT test = max_t(residual, model, averages(columns.values(Eigen::all, tested)), 0,
                          whitener_of(residual), kTestBlocks, kSeed);
  std::vector<MemoryLimit> list;
  for (std::size_t i = 0; i < tested.size(); ++i) {
    // A column that the polynomial explains whole can have any strength.
    const double norm = test.norm[static_cast<Index>(i)];
    const double smallest = norm > 0.0 ? kLimitSigmas / norm : std::numeric_limits<double>::infinity();
    if (tested[i] < C::play(0, 0)) {
      list.push_back({Memory::lag,
                      {{"gain", "deg/h/degC", smallest / columns.half_degc, 0.0},
                       {"node_time_constant", "s",
                        columns.tau_s[static_cast<std::size_t>(tested[i] - C::lag(0))], 0.0}}});
    } else if (tested[i] < C::drift(0, 0)) {
      const double threshold = columns.threshold_degc[static_cast<std::size_t>(tested[i] - C::play(0, 0))];
      list.push_back({Memory::hysteresis,
                      {{"loop_height", "deg/h", smallest * 2.0 * threshold / columns.half_degc, 0.0},
                       {"threshold", "degC", threshold, 0.0}}});
    } else {
      list.push_back({Memory::drift, {{"total_drift", "deg/h", smallest, 0.0}}});
    }
  }
  return list;
}

// Memories of a temperature that was never there: moved round in time, or with random phases. The polynomial
// keeps the measured one. A slow column lowers a slow residual whatever it is, so the best family must beat
// the decoys, not only the polynomial.
void run_decoys(const CaseRows& rows, const std::function<void()>& tick, CaseMemory& result) {
  const NestedSelection& selection = result.selection;
  for (std::size_t i = 0; i < kDecoys; ++i) {
    const Eigen::VectorXd decoy = decoy_of(rows.case_degc, i % 2 == 1, kSeed + i);
    const Eigen::VectorXd residual = decoy_residual(rows, decoy, kMemoryFolds, tick);
    const Gain gain = bootstrap_gain(residual, selection.held_out[at(result.best)], selection.blocks, kSeed);
    result.decoy_rms_dph.push_back(gain.before_rms);
    result.decoys_accepted += gain.low > 0.0 ? 0 : 1;
  }
}

}  // namespace

double share_both_ways(const CaseRows& rows) {
  constexpr Index parts = 50, smoothing = 128;
  const Index n = rows.case_degc.size(), step = std::max<Index>(1, n / smoothing);
  const double low = rows.case_degc.minCoeff(), range = rows.case_degc.maxCoeff() - low;
  std::array<std::array<bool, 2>, parts> seen{};
  for (Index i = step; i + step < n; ++i) {
    const double slope = rows.case_degc[i + step] - rows.case_degc[i - step];
    const auto part = std::min<Index>(
        parts - 1, static_cast<Index>(static_cast<double>(parts) * (rows.case_degc[i] - low) / range));
    // One ramp over the whole recording would change by 0.016 of the range here; an eighth of that is a hold.
    if (std::abs(slope) > 0.002 * range) seen[static_cast<std::size_t>(part)][slope > 0.0 ? 1 : 0] = true;
  }
  const auto both = std::ranges::count_if(seen, [](const auto& part) { return part[0] && part[1]; });
  return static_cast<double>(both) / static_cast<double>(parts);
}

CaseMemory diagnose_case(const CaseRows& rows, const std::function<void()>& tick) {
  CaseMemory result;
  result.selection = nested_selection(rows, kMemoryFolds, tick);
  const NestedSelection& selection = result.selection;
  const auto& polynomial = at(MemoryFamily::polynomial);
  result.both_ways = share_both_ways(rows);
  result.held_out =
      bootstrap_gain(selection.held_out[polynomial], selection.chosen_held_out, selection.blocks, kSeed);
  result.train = bootstrap_gain(selection.train[polynomial], selection.train[at(selection.whole.chosen)],
                                selection.blocks, kSeed);
  const Index n = rows.rate_dph.size();
  result.floor_rms_dph = rms(rows.rate_dph.tail(n - 1) - rows.rate_dph.head(n - 1)) / std::sqrt(2.0);
  Judge judge(result);
  judge.families();
  run_decoys(rows, tick, result);
  judge.verdict();
  const MemoryFamily kept =
      result.verdict == Verdict::consistent ? MemoryFamily::polynomial : selection.whole.chosen;
  result.white_p = ljung_box_p(averages(selection.train[at(kept)]));
  result.limits = limits_of(selection, kept);
  return result;
}

}  // namespace hemi::diagnosis

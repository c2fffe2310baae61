// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/explain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "golden/diagnosis/form_error.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
// [units of the score] What is worth this much is there, also where two of its numbers stand in for each
// other.
constexpr double kUndoubted = 100.0;
constexpr double kTemper = 2.0;  // forms are not exact: differences count half
constexpr double kAgree = 5.0;   // deviations between halves

// Output in which a member of a fit stands out of the noise by most.
Output main_output(Hypotheses& h, const Member& member, const HypothesisFit& fit, std::size_t i) {
  const Reduced& columns = h.columns(member);
  const VectorXd c = fit.coefficients.segment(fit.first[i], columns[0].cols());
  Output main = Output::rate;
  double most = -1.0;
  for (const Output output : kOutputs) {
    const std::size_t k = place(output);
    if (h.space().rows(output) == 0) continue;
    const auto noise = coloured_noise(fit.noise[k], h.space().block_count());
    const double size = whiten(columns[k] * c, h.space().blocks(output), noise).squaredNorm();
    if (size <= most) continue;
    most = size;
    main = output;
  }
  return main;
}

// Half the interval of the first figure is wider than the figure itself by this factor.
constexpr double kUndetermined = 1.5;

bool undetermined(const Explanation& entry) {
  if (entry.figures.empty()) return false;
  const Interval& first = entry.figures.front();
  return 0.5 * (first.high - first.held_by_start - first.low) > kUndetermined * std::abs(first.figure.value);
}

}  // namespace

void explain(TelemetryDiagnosis& result, const SearchResult& found) {
  Hypotheses& h = *result.hypotheses;
  result.members = found.best.members;
  result.final = h.fit(result.members);
  result.baseline = h.fit({}, result.final.noise);
  const auto figures = intervals(h, result.members, result.final);
  std::vector<Output> mains;
  for (std::size_t i = 0; i < result.members.size(); ++i)
    mains.push_back(main_output(h, result.members[i], result.final, i));
  HeldOut unseen = held_out(h, result.members, result.final, result.baseline, mains);
  result.improvement = std::move(unseen.improvements);
  const std::vector<Gain>& alone = unseen.alone;
  for (std::size_t i = 0; i < result.members.size(); ++i) {
    const auto& family = h.families()[result.members[i].family];
    Explanation entry;
    entry.effect = family.effect;
    entry.form = family.form;
    entry.figures = figures[i];
    entry.worth = found.without[i];
    double rest = std::exp(-0.5 * entry.worth / kTemper);
    for (const auto& rival : found.rivals[i]) {
      rest += std::exp(-0.5 * std::max(rival.gap, 0.0) / kTemper);
      if (rival.gap < kNameMargin)
        entry.near.emplace_back(h.families()[rival.member.family].effect, rival.gap);
    }
    entry.probability = 1.0 / (1.0 + rest);
    entry.shape = result.members[i].shape;
    const auto traces = family.columns(h.simulation(), entry.shape);
    const VectorXd c =
        result.final.coefficients.segment(result.final.first[i], static_cast<Index>(traces.size()));
    entry.coefficients.assign(c.begin(), c.end());
    entry.trace = summed(traces, c);
    const auto disagreement = halves_disagree(h, result.members, i, result.final);
    const bool better = (alone.empty() || alone[i].low > 0.0) &&
                        std::ranges::any_of(result.improvement, [&](const Improvement& gain) {
                          return gain.output == mains[i] && gain.held_out_white.low > 0.0;
                        });
    if (result.members.size() > 1 && gain_beside_forms(h, result.members, result.final, i) <
                                         kWorth + EffectSearch(h).penalty(result.members[i])) {
      entry.doubt = "the others' equations may be inexact by as much";
      entry.near.clear();
    } else if (undetermined(entry) && entry.worth < kUndoubted)
      entry.doubt = "its size is not determined beside what equations may be inexact by";
    else if (!entry.near.empty())
      entry.doubt = "other effects explain the recording as well";
    else if (!better)
      entry.doubt = "blocks left out do not become better";
    else if (disagreement && *disagreement > kAgree)
      entry.doubt = fmt::format("the halves of the recording disagree by {:.1f} deviations", *disagreement);
    (entry.doubt.empty() ? result.named : result.ambiguous).push_back(std::move(entry));
  }
}

}  // namespace hemi::diagnosis

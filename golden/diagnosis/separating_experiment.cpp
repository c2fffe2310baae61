// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/separating_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace hemi::diagnosis {
namespace {

constexpr double kStimulusEffort_s = 3600.0;
constexpr double kShareOfReach = 0.7;  // asked of pairs that no experiment separates by enough_gap()
constexpr std::size_t kRichest = 3;
constexpr std::size_t kNearest = 4;
constexpr double kSameLag = 0.02;

using Pair = std::pair<std::string, std::string>;
// Gap that is asked of every pair that can be separated.
using Asked = std::map<Pair, double>;

struct Candidate {
  Experiment experiment;
  double effort_s = 0.0;
  double share = 0.0;  // of what is asked between alternatives, where it is least
};

std::vector<Candidate> candidates(const Stand& stand) {
  std::vector<Candidate> list;
  std::vector<std::vector<Stimulus>> beside = {{}};
  for (const Stimulus one : kStimuli) beside.push_back({one});
  beside.emplace_back(kStimuli.begin(), kStimuli.end());
  for (const auto& program : chamber_programs(stand))
    for (const auto& stimuli : beside)
      list.push_back({with_stimuli(program, stimuli, stand),
                      program.duration_s + kStimulusEffort_s * static_cast<double>(stimuli.size())});
  std::ranges::stable_sort(list, {}, &Candidate::effort_s);
  return list;
}

Pair names(const ExpectedGap& gap) {
  return gap.alternative && gap.rival < gap.truth ? Pair{gap.rival, gap.truth} : Pair{gap.truth, gap.rival};
}

// A rival that the experiment cannot show is none.
double least_share(const std::vector<ExpectedGap>& gaps, const Asked& asked) {
  double share = 1.0;
  for (const auto& gap : gaps)
    if (const auto found = asked.find(names(gap)); found != asked.end())
      share = std::min(share, std::max(gap.gap, 0.0) / found->second);
  return share;
}

class Search {
 public:
  Search(const TelemetryDiagnosis& diagnosis, const NominalModel& model, const ExperimentOptions& options)
      : diagnosis_(diagnosis), model_(model), options_(options), sets_(alternative_sets(diagnosis)) {}
  std::optional<SeparatingExperiment> run();

 private:
  std::vector<ExpectedGap> gaps(const Experiment& experiment, Rivals rivals) const {
    return by_pair(expected_gaps(experiment, result_.stand, model_, diagnosis_, sets_, rivals));
  }
  // A board whose lag is all but the resonator's tells nothing of its own: no experiment must rest on the
  // difference.
  void settle_board();
  Asked asked_of(const std::vector<Candidate>& list);
  void choose(std::vector<Candidate>& list, const Asked& asked);
  void keep(const Candidate& chosen, const std::vector<ExpectedGap>& found, const Asked& asked);

  const TelemetryDiagnosis& diagnosis_;
  const NominalModel& model_;
  const ExperimentOptions& options_;
  std::vector<AlternativeSet> sets_;
  SeparatingExperiment result_;
};

void Search::settle_board() {
  double& lag_s = result_.stand.board_lag_s;
  for (const double tau_s : {model_.time_constant_s, diagnosis_.corrected.time_constant_s})
    if (std::abs(lag_s - tau_s) < kSameLag * tau_s) lag_s = model_.time_constant_s;
}

// What can be had at all: everything at once, over the most varied programs.
Asked Search::asked_of(const std::vector<Candidate>& list) {
  std::map<Pair, ExpectedGap> reach;
  std::size_t tried = 0;
  for (auto each = list.rbegin(); each != list.rend() && tried < kRichest; ++each) {
    if (each->experiment.steps.size() != kStimuli.size()) continue;
    options_.tick(0.0);
    ++tried;
    for (const auto& gap : gaps(each->experiment, Rivals::catalogue)) {
      const auto found = reach.try_emplace(names(gap), gap).first;
      if (gap.gap > found->second.gap) found->second = gap;
    }
  }
  Asked asked;
  for (const auto& [pair, gap] : reach) {
    if (gap.gap >= kNameMargin)
      asked[pair] = std::min(enough_gap(), kShareOfReach * gap.gap);
    else if (gap.alternative)
      result_.inseparable.push_back(gap);
  }
  const bool any = std::ranges::any_of(
      reach, [](const auto& entry) { return entry.second.alternative && entry.second.gap >= kNameMargin; });
  return any ? asked : Asked{};
}

void Search::keep(const Candidate& chosen, const std::vector<ExpectedGap>& found, const Asked& asked) {
  result_.experiment = chosen.experiment;
  result_.gaps.clear();
  for (const auto& gap : found)
    if (gap.alternative && asked.contains(names(gap))) result_.gaps.push_back(gap);
  result_.enough =
      std::ranges::all_of(result_.gaps, [](const ExpectedGap& each) { return each.gap >= enough_gap(); });
}

// The alternatives alone first, which takes a tenth of the time: what does not separate them need not be
// compared with the whole catalogue.
void Search::choose(std::vector<Candidate>& list, const Asked& asked) {
  for (auto& each : list) {
    options_.tick(static_cast<double>(result_.tried++) / static_cast<double>(list.size()));
    each.share = least_share(gaps(each.experiment, Rivals::alternatives), asked);
    if (each.share < 1.0) continue;
    const auto found = gaps(each.experiment, Rivals::catalogue);
    each.share = least_share(found, asked);
    if (each.share >= 1.0) return keep(each, found, asked);
  }
  std::ranges::stable_sort(list, std::ranges::greater{}, &Candidate::share);
  double best = -1.0;
  for (std::size_t i = 0; i < std::min(kNearest, list.size()); ++i) {
    options_.tick(1.0);
    const auto found = gaps(list[i].experiment, Rivals::catalogue);
    const double share = least_share(found, asked);
    if (share <= best) continue;
    best = share;
    keep(list[i], found, asked);
  }
}

std::optional<SeparatingExperiment> Search::run() {
  if (sets_.empty()) return std::nullopt;
  result_.stand = stand_of(*diagnosis_.telemetry, model_);
  settle_board();
  auto list = candidates(result_.stand);
  const Asked asked = asked_of(list);
  if (!asked.empty()) choose(list, asked);
  return result_;
}

}  // namespace

double enough_gap() {
  const double root = kSureBy + std::sqrt(kSureBy * kSureBy + kNameMargin);
  return 2.0 * root * root;
}

std::optional<SeparatingExperiment> find_separating_experiment(const TelemetryDiagnosis& diagnosis,
                                                               const NominalModel& model,
                                                               const ExperimentOptions& options) {
  return Search(diagnosis, model, options).run();
}

}  // namespace hemi::diagnosis

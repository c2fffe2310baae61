// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/separating_experiment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "golden/diagnosis/scaled_normal.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double kStep_s = 30.0;
constexpr double kWeaker = 2.0;  // standard errors
constexpr int kRefinements = 3;
constexpr std::size_t kRefined = 3;        // nearest rivals of a truth whose shapes are refined
constexpr double kLongestDelay_s = 300.0;  // beyond it a delay is no rival that a diagnosis would try
constexpr double kStimulusEffort_s = 3600.0;
constexpr double kShareOfReach = 0.7;  // asked of pairs that no experiment separates by kEnoughGap

Noise rescaled(const Noise& noise, const Simulation& from, double from_s, const Simulation& to, double to_s) {
  Noise result = noise;
  const double softer =
      to.frequency_per_degc.square().mean() / std::max(from.frequency_per_degc.square().mean(), 1e-300);
  for (auto& part : result) {
    part.white *= from_s / to_s;
    part.walk *= to_s / from_s;
    part.behind *= softer;
    if (part.behind_correlation > 0.0)
      part.behind_correlation = std::pow(part.behind_correlation, to_s / from_s);
  }
  return result;
}

// One experiment with one set of alternatives, simulated and compared.
class Comparison {
 public:
  Comparison(const Experiment& experiment, const Stand& stand, const NominalModel& model,
             const TelemetryDiagnosis& diagnosis, const AlternativeSet& set);
  std::vector<ExpectedGap> gaps();

 private:
  struct Fitted {
    double left = std::numeric_limits<double>::infinity();  // squares, price included
    Member member;
  };
  void whiten_grid();
  MatrixXd white(const Member& member);
  void take_off(MatrixXd& columns) const;
  double left_by(const MatrixXd& columns, const Member& member, const VectorXd& truth) const;
  void gaps_of(const FittedEffect& truth, std::vector<ExpectedGap>& list);
  Fitted refined(Fitted fitted, const VectorXd& truth);
  bool tried(const Member& member) const;

  const TelemetryDiagnosis& diagnosis_;
  const AlternativeSet& set_;
  Telemetry telemetry_;
  std::unique_ptr<Hypotheses> hypotheses_;
  Noise noise_;
  std::vector<Member> others_;
  MatrixXd own_;
  Eigen::LDLT<MatrixXd> normal_;
  VectorXd scale_;
  std::vector<Member> grid_;  // of all rivals
  std::vector<MatrixXd> grid_white_;
};

Comparison::Comparison(const Experiment& experiment, const Stand& stand, const NominalModel& model,
                       const TelemetryDiagnosis& diagnosis, const AlternativeSet& set)
    : diagnosis_(diagnosis), set_(set), telemetry_(inputs_of(experiment, stand, kStep_s)) {
  const Hypotheses& old = *diagnosis.hypotheses;
  Simulation s = simulate(telemetry_, model);
  const auto record = [&](const Trace& outputs) {
    for (const Output output : kOutputs)
      if (old.space().rows(output) > 0) telemetry_.outputs[place(output)] = outputs[output];
  };
  record(s.nominal);
  // Effects that every alternative shares are there; what follows from commands follows from theirs as well.
  Trace outputs = s.nominal;
  const auto first = effect_families(s);
  for (const auto& other : set.others) {
    const auto carried = carried_over(other, old.simulation(), s, first);
    if (!carried) continue;
    const Trace added =
        summed(first[carried->member.family].columns(s, carried->member.shape), carried->coefficients);
    for (const Output output : kOutputs)
      if (added[output].size() > 0) outputs[output] += added[output];
  }
  record(outputs);
  const double before_s = old.simulation().telemetry->step_s * static_cast<double>(old.space().block_rows());
  noise_ = rescaled(diagnosis.final.noise, old.simulation(), before_s, s, kStep_s);
  auto families = effect_families(s);
  hypotheses_ = std::make_unique<Hypotheses>(telemetry_, RowSpace(telemetry_, telemetry_.rows()),
                                             std::move(s), std::move(families));
  for (const auto& other : set.others)
    if (const auto carried =
            carried_over(other, old.simulation(), hypotheses_->simulation(), hypotheses_->families()))
      others_.push_back(carried->member);
  own_ = whiten(hypotheses_->space(), noise_, hypotheses_->design(others_));
  // An experiment without the thermometer's noise may leave a column at zero: it takes no part.
  const VectorXd size = own_.colwise().norm();
  scale_ = (size.array() > 0.0).select(size.cwiseInverse(), 0.0);
  MatrixXd normal = scale_.asDiagonal() * (own_.transpose() * own_) * scale_.asDiagonal();
  normal.diagonal() += scale_.cwiseAbs2().cwiseProduct(hypotheses_->prior_precision(own_.cols()));
  normal.diagonal().array() += 1e-12;
  normal_.compute(normal);
  whiten_grid();
}

// All at once: the filter is the same for every column.
void Comparison::whiten_grid() {
  const auto& families = hypotheses_->families();
  std::vector<const Reduced*> parts;
  for (std::size_t f = 0; f < families.size(); ++f) {
    const bool shared = std::ranges::any_of(
        others_, [&](const Member& member) { return families[member.family].effect == families[f].effect; });
    if (shared) continue;
    for (const auto& shape : families[f].grid) {
      if (!tried({f, shape})) continue;
      grid_.push_back({f, shape});
      parts.push_back(&hypotheses_->columns(grid_.back()));
    }
  }
  if (parts.empty()) return;
  MatrixXd all = whiten(hypotheses_->space(), noise_, joined(parts));
  take_off(all);
  Index at = 0;
  for (const auto* part : parts) {
    grid_white_.emplace_back(all.middleCols(at, (*part)[0].cols()));
    at += (*part)[0].cols();
  }
}

MatrixXd Comparison::white(const Member& member) {
  MatrixXd columns = whiten(hypotheses_->space(), noise_, hypotheses_->columns(member));
  take_off(columns);
  return columns;
}

// What the nominal model and the shared effects can do.
void Comparison::take_off(MatrixXd& columns) const {
  const VectorXd before = columns.colwise().norm();
  columns -= own_ * (scale_.asDiagonal() * normal_.solve(scale_.asDiagonal() * (own_.transpose() * columns)));
  for (Index j = 0; j < columns.cols(); ++j)
    if (columns.col(j).norm() < 1e-6 * before[j]) columns.col(j).setZero();
}

// Infinite where the physics cannot have the strength that fits best.
double Comparison::left_by(const MatrixXd& columns, const Member& member, const VectorXd& truth) const {
  const VectorXd c =
      ScaledNormal(columns, VectorXd::Zero(columns.cols()), 1e-9).solve(columns.transpose() * truth);
  const auto& family = hypotheses_->families()[member.family];
  if (family.possible && !family.possible(hypotheses_->simulation(), {c.begin(), c.end()}, member.shape))
    return std::numeric_limits<double>::infinity();
  return (truth - columns * c).squaredNorm() + EffectSearch(*hypotheses_).penalty(member);
}

bool Comparison::tried(const Member& member) const {
  const auto& effect = hypotheses_->families()[member.family].effect;
  if (effect == "time_shift") return member.shape[0] * kStep_s <= kLongestDelay_s;
  if (effect == "pll_lag") return member.shape[0] <= kLongestDelay_s;
  return true;
}

Comparison::Fitted Comparison::refined(Fitted fitted, const VectorXd& truth) {
  const auto& family = hypotheses_->families()[fitted.member.family];
  double share = 0.5;
  for (int round = 0; round < kRefinements; ++round, share *= 0.5)
    for (std::size_t d = 0; d < family.spacing.size(); ++d)
      for (const double sign : {1.0, -1.0}) {
        Member moved = fitted.member;
        moved.shape[d] *= std::pow(family.spacing[d], sign * share);
        const double left = left_by(white(moved), moved, truth);
        if (left < fitted.left) fitted = {left, moved};
      }
  return fitted;
}

void Comparison::gaps_of(const FittedEffect& truth, std::vector<ExpectedGap>& list) {
  const auto& families = hypotheses_->families();
  const auto carried =
      carried_over(truth, diagnosis_.hypotheses->simulation(), hypotheses_->simulation(), families);
  const auto among = [&](const std::string& effect) {
    return std::ranges::any_of(set_.alternatives, [&](const auto& each) { return each.effect == effect; });
  };
  if (!carried) {
    // A run that cannot show the truth tells it from nothing.
    list.push_back({truth.effect, "", 0.0, false});
    for (const auto& rival : set_.alternatives)
      if (rival.effect != truth.effect) list.push_back({truth.effect, rival.effect, 0.0, true});
    return;
  }
  const double weaker = std::max(0.0, 1.0 - kWeaker / std::max(truth.deviations, 1e-9));
  const VectorXd trace = weaker * (white(carried->member) * carried->coefficients);
  const double price = EffectSearch(*hypotheses_).penalty(carried->member);
  list.push_back({truth.effect, "", trace.squaredNorm() - price, false});
  std::map<std::string, Fitted> best;
  for (std::size_t i = 0; i < grid_.size(); ++i) {
    const auto& effect = families[grid_[i].family].effect;
    if (effect == truth.effect) continue;
    const double left = left_by(grid_white_[i], grid_[i], trace);
    Fitted& nearest = best[effect];
    if (left < nearest.left) nearest = {left, grid_[i]};
  }
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [effect, fitted] : best) order.emplace_back(fitted.left, effect);
  std::ranges::sort(order);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto& effect = order[i].second;
    const bool own = among(effect);
    Fitted fitted = best[effect];
    if (std::isinf(fitted.left)) continue;
    if (i < kRefined || own) fitted = refined(std::move(fitted), trace);
    list.push_back({truth.effect, effect, fitted.left - price, own});
  }
}

std::vector<ExpectedGap> Comparison::gaps() {
  std::vector<ExpectedGap> list;
  for (const auto& truth : set_.alternatives) gaps_of(truth, list);
  return list;
}

// Of an effect in several forms the one that shows best: it may come in any. Then the smaller gap of the two
// ways round for every pair of alternatives; outside them the way that there is.
using Pair = std::pair<std::string, std::string>;
std::map<Pair, ExpectedGap> by_pair(const std::vector<ExpectedGap>& gaps) {
  std::map<Pair, ExpectedGap> ways, pairs;
  for (const auto& each : gaps) {
    const auto found = ways.try_emplace({each.truth, each.rival}, each).first;
    if (each.gap > found->second.gap) found->second = each;
  }
  for (const auto& [way, each] : ways) {
    const bool turn = each.alternative && each.rival < each.truth;
    const auto found = pairs.try_emplace(turn ? Pair{each.rival, each.truth} : way, each).first;
    if (each.gap < found->second.gap) found->second = each;
  }
  return pairs;
}

struct Candidate {
  Experiment experiment;
  double effort_s = 0.0;
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

}  // namespace

std::vector<ExpectedGap> expected_gaps(const Experiment& experiment, const Stand& stand,
                                       const NominalModel& model, const TelemetryDiagnosis& diagnosis,
                                       const std::vector<AlternativeSet>& sets) {
  std::vector<ExpectedGap> all;
  for (const auto& set : sets)
    for (auto& gap : Comparison(experiment, stand, model, diagnosis, set).gaps())
      all.push_back(std::move(gap));
  return all;
}

std::optional<SeparatingExperiment> find_separating_experiment(const TelemetryDiagnosis& diagnosis,
                                                               const NominalModel& model,
                                                               const ExperimentOptions& options) {
  const auto sets = alternative_sets(diagnosis);
  if (sets.empty()) return std::nullopt;
  SeparatingExperiment result;
  result.stand = stand_of(*diagnosis.telemetry, model);
  const auto list = candidates(result.stand);
  // What can be had at all: everything at once, over the most varied programs.
  std::map<Pair, ExpectedGap> reach;
  std::vector<const Candidate*> richest;
  for (const auto& each : list)
    if (each.experiment.steps.size() == kStimuli.size()) richest.push_back(&each);
  std::ranges::reverse(richest);
  richest.resize(std::min<std::size_t>(richest.size(), 4));
  for (const auto* each : richest) {
    options.tick(0.0);
    for (const auto& [pair, gap] :
         by_pair(expected_gaps(each->experiment, result.stand, model, diagnosis, sets))) {
      const auto found = reach.try_emplace(pair, gap).first;
      if (gap.gap > found->second.gap) found->second = gap;
    }
  }
  std::map<Pair, double> asked;
  for (const auto& [pair, gap] : reach) {
    if (gap.gap >= kNameMargin)
      asked[pair] = std::min(kEnoughGap, kShareOfReach * gap.gap);
    else if (gap.alternative)
      result.inseparable.push_back(gap);
  }
  const bool any = std::ranges::any_of(
      reach, [&](const auto& entry) { return entry.second.alternative && entry.second.gap >= kNameMargin; });
  if (!any) return result;
  double best = -1.0;
  for (const auto& each : list) {
    options.tick(static_cast<double>(result.tried++) / static_cast<double>(list.size()));
    const auto gaps = by_pair(expected_gaps(each.experiment, result.stand, model, diagnosis, sets));
    double share = 1.0;
    for (const auto& [pair, least] : asked) {
      const auto found = gaps.find(pair);
      // A rival that the experiment cannot show is none.
      if (found != gaps.end()) share = std::min(share, std::max(found->second.gap, 0.0) / least);
    }
    if (share <= best) continue;
    best = share;
    result.experiment = each.experiment;
    result.gaps.clear();
    for (const auto& [pair, gap] : gaps)
      if (gap.alternative && asked.contains(pair)) result.gaps.push_back(gap);
    if (share >= 1.0) break;
  }
  result.enough =
      std::ranges::all_of(result.gaps, [](const ExpectedGap& each) { return each.gap >= kEnoughGap; });
  return result;
}

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/expected_gaps.hpp"

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
constexpr int kGapRefinements = 3;
constexpr std::size_t kRefined = 3;        // nearest rivals of a truth whose shapes are refined
constexpr double kLongestDelay_s = 300.0;  // beyond it a delay is no rival that a diagnosis would try

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
             const TelemetryDiagnosis& diagnosis, const AlternativeSet& set, Rivals rivals);
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
  bool among(const std::string& effect) const;
  bool has_form(const std::string& rival, const std::string& form) const;

  const TelemetryDiagnosis& diagnosis_;
  const AlternativeSet& set_;
  Rivals rivals_;
  Telemetry telemetry_;
  std::unique_ptr<Hypotheses> hypotheses_;
  Noise noise_;
  std::vector<Member> others_;
  MatrixXd own_;
  std::optional<ScaledNormal> normal_;
  std::vector<Member> grid_;  // of all rivals
  std::vector<MatrixXd> grid_white_;
};

Comparison::Comparison(const Experiment& experiment, const Stand& stand, const NominalModel& model,
                       const TelemetryDiagnosis& diagnosis, const AlternativeSet& set, Rivals rivals)
    : diagnosis_(diagnosis), set_(set), rivals_(rivals), telemetry_(inputs_of(experiment, stand, kStep_s)) {
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
  normal_.emplace(own_, hypotheses_->prior_precision(own_.cols()));
  whiten_grid();
}

// All at once: the filter is the same for every column.
void Comparison::whiten_grid() {
  const auto& families = hypotheses_->families();
  std::vector<const Reduced*> parts;
  for (std::size_t f = 0; f < families.size(); ++f) {
    const bool shared = std::ranges::any_of(
        others_, [&](const Member& member) { return families[member.family].effect == families[f].effect; });
    if (shared || (rivals_ == Rivals::alternatives && !among(families[f].effect))) continue;
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
  columns -= own_ * normal_->solve(own_.transpose() * columns);
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

bool Comparison::among(const std::string& effect) const {
  return std::ranges::any_of(set_.alternatives, [&](const auto& each) { return each.effect == effect; });
}

bool Comparison::has_form(const std::string& rival, const std::string& form) const {
  return family_of(hypotheses_->families(), rival, form).has_value();
}

Comparison::Fitted Comparison::refined(Fitted fitted, const VectorXd& truth) {
  const auto& family = hypotheses_->families()[fitted.member.family];
  double share = 0.5;
  for (int round = 0; round < kGapRefinements; ++round, share *= 0.5)
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
  if (!carried) {
    // A run that cannot show the truth tells it from nothing.
    list.push_back({truth.effect, "", 0.0});
    for (const auto& rival : set_.alternatives)
      if (rival.effect != truth.effect) list.push_back({truth.effect, rival.effect, 0.0, true});
    return;
  }
  const double weaker = std::max(0.0, 1.0 - kWeaker / std::max(truth.deviations, 1e-9));
  const VectorXd trace = weaker * (white(carried->member) * carried->coefficients);
  const double price = EffectSearch(*hypotheses_).penalty(carried->member);
  list.push_back({truth.effect, "", trace.squaredNorm() - price});
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
    list.push_back({truth.effect, effect, fitted.left - price, own, has_form(effect, truth.form)});
  }
}

std::vector<ExpectedGap> Comparison::gaps() {
  std::vector<ExpectedGap> list;
  for (const auto& truth : set_.alternatives) gaps_of(truth, list);
  return list;
}

}  // namespace

std::vector<ExpectedGap> expected_gaps(const Experiment& experiment, const Stand& stand,
                                       const NominalModel& model, const TelemetryDiagnosis& diagnosis,
                                       const std::vector<AlternativeSet>& sets, Rivals rivals) {
  std::vector<ExpectedGap> all;
  for (const auto& set : sets)
    for (auto& gap : Comparison(experiment, stand, model, diagnosis, set, rivals).gaps())
      all.push_back(std::move(gap));
  return all;
}

std::vector<ExpectedGap> by_pair(const std::vector<ExpectedGap>& gaps) {
  std::map<std::pair<std::string, std::string>, ExpectedGap> pairs;
  for (const auto& each : gaps) {
    const bool turn = each.alternative && each.rival < each.truth;
    const auto [found, first] =
        pairs.try_emplace(turn ? std::pair(each.rival, each.truth) : std::pair(each.truth, each.rival), each);
    if (first) continue;
    auto& kept = found->second;
    if (kept.shared != each.shared ? kept.shared : each.gap < kept.gap) kept = each;
  }
  std::vector<ExpectedGap> list;
  for (const auto& [names, each] : pairs) list.push_back(each);
  return list;
}

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/alternatives.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

FittedEffect fitted(Hypotheses& h, const Member& member, const HypothesisFit& fit, std::size_t place) {
  const auto& family = h.families()[member.family];
  FittedEffect effect{family.effect, family.form, member.shape, {}, 0.0};
  const Index count = h.columns(member)[0].cols();
  const VectorXd c = fit.coefficients.segment(fit.first[place], count);
  effect.coefficients.assign(c.begin(), c.end());
  const MatrixXd covariance = fit.covariance.block(fit.first[place], fit.first[place], count, count);
  effect.deviations = std::sqrt(std::max(c.dot(covariance.completeOrthogonalDecomposition().solve(c)), 0.0));
  return effect;
}

// Forms of effects that explain as much as the effect's best one beside `others`, within the margin of a
// name: the recording cannot say in which of them the effect comes.
std::vector<Member> forms(Hypotheses& h, const std::vector<std::string>& effects,
                          const std::vector<Member>& others, const Noise& noise) {
  EffectSearch search(h);
  const auto all = search.gains(others, noise);
  std::vector<Member> list;
  for (const auto& effect : effects) {
    std::map<std::size_t, std::pair<double, Member>> best;  // by family
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < all.members.size(); ++i) {
      const Member& member = all.members[i];
      if (h.families()[member.family].effect != effect) continue;
      const double worth = all.gain[i] - search.penalty(member);
      const auto found = best.try_emplace(member.family, worth, member).first;
      if (worth > found->second.first) found->second = {worth, member};
      most = std::max(most, worth);
    }
    for (const auto& [family, entry] : best)
      if (entry.first > most - kNameMargin) list.push_back(search.refined(entry.second, others, noise));
  }
  return list;
}

// sum c_i (x - from)^i as powers of (x - to), i = 1, 2, ...; the constant is the baseline's.
VectorXd recentred(const VectorXd& c, double from, double to) {
  VectorXd result = VectorXd::Zero(c.size());
  for (Index i = 0; i < c.size(); ++i) {
    const Index power = i + 1;
    double binomial = 1.0;
    for (Index k = power; k >= 1; --k) {
      result[k - 1] += c[i] * binomial * std::pow(to - from, static_cast<double>(power - k));
      binomial *= static_cast<double>(k) / static_cast<double>(power - k + 1);
    }
  }
  return result;
}

}  // namespace

std::vector<AlternativeSet> alternative_sets(const TelemetryDiagnosis& diagnosis) {
  std::vector<AlternativeSet> sets;
  Hypotheses& h = *diagnosis.hypotheses;
  for (const auto& entry : diagnosis.ambiguous) {
    const auto family = family_of(h.families(), entry.effect, entry.form);
    if (!family || entry.near.empty()) continue;
    const auto own = std::ranges::find(diagnosis.members, *family, &Member::family);
    if (own == diagnosis.members.end()) continue;
    const auto place = static_cast<std::size_t>(own - diagnosis.members.begin());
    std::vector<Member> others = diagnosis.members;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
    AlternativeSet set;
    for (std::size_t i = 0; i < diagnosis.members.size(); ++i)
      if (i != place) set.others.push_back(fitted(h, diagnosis.members[i], diagnosis.final, i));
    set.alternatives.push_back(fitted(h, *own, diagnosis.final, place));
    std::vector<std::string> effects = {entry.effect};
    for (const auto& [id, gap] : entry.near) effects.push_back(id);
    for (const auto& form : forms(h, effects, others, diagnosis.final.noise)) {
      if (form.family == own->family) continue;
      std::vector<Member> members = others;
      members.push_back(form);
      set.alternatives.push_back(fitted(h, form, h.fit(members, diagnosis.final.noise), others.size()));
    }
    if (set.alternatives.size() > 1) sets.push_back(std::move(set));
  }
  return sets;
}

std::optional<CarriedEffect> carried_over(const FittedEffect& effect, const Simulation& from,
                                          const Simulation& to, const std::vector<EffectFamily>& families) {
  const auto family = family_of(families, effect.effect, effect.form);
  if (!family) return std::nullopt;
  CarriedEffect carried;
  carried.member = {*family, effect.shape};
  carried.coefficients =
      VectorXd::Map(effect.coefficients.data(), static_cast<Index>(effect.coefficients.size()));
  auto& shape = carried.member.shape;
  const double here = span(from.smooth_degc), there = span(to.smooth_degc);
  const std::string& id = effect.effect;
  if (id == "thermal_hysteresis") {
    for (double& share : shape) share *= here / there;
  } else if ((id == "damping_temperature" || id == "frequency_split") && shape.size() == 2) {
    const double centre = from.smooth_degc.minCoeff() + shape[0] * here;
    shape = {(centre - to.smooth_degc.minCoeff()) / there, shape[1] * here / there};
  } else if (id == "oscillator_temperature") {
    carried.coefficients = recentred(carried.coefficients, from.board_degc.mean(), to.board_degc.mean());
  } else if (id == "time_shift") {
    shape[0] *= from.telemetry->step_s / to.telemetry->step_s;
  }
  return carried;
}

}  // namespace hemi::diagnosis

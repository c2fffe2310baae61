// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/effect_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "golden/diagnosis/scaled_normal.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Members = std::vector<Member>;

// Price of an effect: its choice among some thirty, a coefficient, a shape parameter.
constexpr double kPerEffect = 14.0;
constexpr double kPerCoefficient = 4.0;
constexpr double kPerShape = 3.0;
constexpr std::size_t kMostMembers = 4;
constexpr std::size_t kSingleProposals = 6;
constexpr std::size_t kPairProposals = 3;
constexpr int kRefinements = 5;
constexpr int kMostSwaps = 3;
constexpr double kEdge = 2.0;     // deviations beyond what is possible
constexpr double kShared = 1e-9;  // ridge: columns of one effect may all but coincide

// Takes off what `set` explains. A column that keeps less than 1e-9 of itself is part of the set.
void take_off(const MatrixXd& set, const VectorXd& prior, MatrixXd& columns) {
  const VectorXd before = columns.colwise().norm();
  columns -= set * ScaledNormal(set, prior).solve(set.transpose() * columns);
  for (Index j = 0; j < columns.cols(); ++j)
    if (columns.col(j).norm() < 1e-6 * before[j]) columns.col(j).setZero();
}

// Coefficients of a set of columns given by products.
VectorXd solved(const MatrixXd& products, const VectorXd& with_data) {
  return ScaledNormal::of_products(products, kShared).solve(with_data);
}

// e' C (C'C)^-1 C' e over them.
double explained(const MatrixXd& products, const VectorXd& with_data) {
  return with_data.dot(solved(products, with_data));
}

// The second of a pair that no recording of one clock can part.
const std::string& kind_of(const std::string& effect) {
  static const std::string kOfClock = "oscillator_ageing", kOfResonator = "frequency_ageing";
  return effect == kOfClock ? kOfResonator : effect;
}

// Effects that came one after another may have taken each other's place.
std::optional<ScoredSet> swapped_for_the_better(const ScoredSet& best,
                                                const std::vector<std::vector<Rival>>& rivals) {
  const Rival* least = nullptr;
  std::size_t place = 0;
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    if (rivals[i].empty() || rivals[i].front().gap >= (least ? least->gap : 0.0)) continue;
    least = &rivals[i].front();
    place = i;
  }
  if (!least) return std::nullopt;
  ScoredSet swapped = best;
  swapped.members[place] = least->member;
  swapped.score += least->gap;
  return swapped;
}

}  // namespace

double EffectSearch::penalty(const Member& member) const {
  const auto& family = hypotheses_.families()[member.family];
  const auto coefficients = hypotheses_.columns(member)[0].cols();
  return kPerEffect + kPerCoefficient * static_cast<double>(coefficients) +
         kPerShape * static_cast<double>(family.spacing.size());
}

ScoredSet EffectSearch::scored(Members members) {
  const auto fit = hypotheses_.fit(members);
  double score = fit.minus_two_log_likelihood;
  // Colour has a price as well, or it would stand in for every slow effect.
  for (const Output output : kOutputs) {
    const NoiseShape& noise = fit.noise[place(output)];
    const double price = std::log(static_cast<double>(std::max<Index>(2, hypotheses_.space().rows(output))));
    for (const double part : {noise.flicker, noise.walk, noise.behind})
      if (part > 0.0) score += price;
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    const auto& family = hypotheses_.families()[members[i].family];
    score += penalty(members[i]);
    if (!family.possible) continue;
    const Index count = hypotheses_.columns(members[i])[0].cols();
    const VectorXd c = fit.coefficients.segment(fit.first[i], count);
    const VectorXd deviations =
        fit.covariance.diagonal().segment(fit.first[i], count).cwiseMax(0.0).cwiseSqrt();
    const auto possible = [&](const VectorXd& at) {
      return family.possible(hypotheses_.simulation(), {at.begin(), at.end()}, members[i].shape);
    };
    // Where two numbers stand in for each other, refinement ends at the edge, and noise estimated anew moves
    // beyond it.
    bool near = possible(c);
    for (Index k = 0; k < count && !near; ++k)
      for (const double off : {-kEdge, kEdge})
        near |= possible(c + off * deviations[k] * VectorXd::Unit(count, k));
    if (!near) score = std::numeric_limits<double>::infinity();
  }
  return {std::move(members), score};
}

EffectSearch::Gains EffectSearch::gains(const Members& set, const Noise& noise) {
  Gains result;
  std::vector<const Reduced*> parts;
  Index at = 0;
  for (std::size_t f = 0; f < hypotheses_.families().size(); ++f)
    for (const auto& shape : hypotheses_.families()[f].grid) {
      result.members.push_back({f, shape});
      parts.push_back(&hypotheses_.columns(result.members.back()));
      result.begin.push_back(at);
      result.count.push_back((*parts.back())[0].cols());
      at += result.count.back();
    }
  parts.push_back(&hypotheses_.data());
  MatrixXd columns = whiten(hypotheses_.space(), noise, joined(parts));
  const MatrixXd own = whiten(hypotheses_.space(), noise, hypotheses_.design(set));
  take_off(own, hypotheses_.prior_precision(own.cols()), columns);
  const MatrixXd all = columns.transpose() * columns;
  result.products = all.topLeftCorner(at, at);
  result.with_data = all.col(at).head(at);
  for (std::size_t i = 0; i < result.members.size(); ++i)
    result.gain.push_back(
        gain(result.members[i],
             result.products.block(result.begin[i], result.begin[i], result.count[i], result.count[i]),
             result.with_data.segment(result.begin[i], result.count[i])));
  return result;
}

double EffectSearch::gain(const Member& member, const MatrixXd& products, const VectorXd& with_data) const {
  const VectorXd c = solved(products, with_data);
  const auto& family = hypotheses_.families()[member.family];
  if (family.possible && !family.possible(hypotheses_.simulation(), {c.begin(), c.end()}, member.shape))
    return 0.0;
  return with_data.dot(c);
}

Member EffectSearch::refined(const Member& member, const Members& others, const Noise& noise) {
  const auto& family = hypotheses_.families()[member.family];
  if (family.spacing.empty()) return member;
  const MatrixXd own = whiten(hypotheses_.space(), noise, hypotheses_.design(others));
  const VectorXd prior = hypotheses_.prior_precision(own.cols());
  const auto gain_at = [&](const std::vector<double>& shape) {
    const auto traces = family.columns(hypotheses_.simulation(), shape);
    std::vector<const Trace*> list;
    for (const auto& trace : traces) list.push_back(&trace);
    const Reduced reduced = hypotheses_.space().reduce(list);
    MatrixXd columns = whiten(hypotheses_.space(), noise, joined({&reduced, &hypotheses_.data()}));
    take_off(own, prior, columns);
    const MatrixXd all = columns.transpose() * columns;
    const Index n = all.cols() - 1;
    return gain({member.family, shape}, all.topLeftCorner(n, n), all.col(n).head(n));
  };
  Member best = member;
  double most = gain_at(best.shape);
  double share = 0.5;
  for (int round = 0; round < kRefinements; ++round, share *= 0.5)
    for (std::size_t d = 0; d < family.spacing.size(); ++d)
      for (const double sign : {1.0, -1.0}) {
        auto shape = best.shape;
        shape[d] *= std::pow(family.spacing[d], sign * share);
        const double found = gain_at(shape);
        if (found <= most) continue;
        most = found;
        best.shape = shape;
        break;
      }
  return best;
}

std::vector<Members> EffectSearch::proposals(const Members& set, bool pairs) {
  std::vector<Members> list;
  const auto& families = hypotheses_.families();
  const auto taken = [&](const std::string& effect) {
    return std::ranges::any_of(
        set, [&](const Member& m) { return kind_of(families[m.family].effect) == kind_of(effect); });
  };
  const auto own = hypotheses_.fit(set).noise;
  for (const Noise& noise : {hypotheses_.expected(), own}) {
    const Gains all = gains(set, noise);
    // The best form of every effect, by its gain less its price.
    std::map<std::string, std::size_t> best;
    const auto worth = [&](std::size_t i) { return all.gain[i] - penalty(all.members[i]); };
    for (std::size_t i = 0; i < all.members.size(); ++i) {
      const auto& effect = families[all.members[i].family].effect;
      if (taken(effect)) continue;
      const auto found = best.find(effect);
      if (found == best.end() || worth(i) > worth(found->second)) best[effect] = i;
    }
    std::vector<std::size_t> order;
    for (const auto& [effect, i] : best)
      if (worth(i) > 0.0) order.push_back(i);
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return worth(a) > worth(b); });
    for (std::size_t i = 0; i < std::min(order.size(), kSingleProposals); ++i) {
      Members more = set;
      more.push_back(refined(all.members[order[i]], set, noise));
      list.push_back(std::move(more));
    }
    if (!pairs) continue;
    struct Pair {
      double worth;
      std::size_t a, b;
    };
    std::map<std::pair<std::string, std::string>, Pair> best_pairs;
    for (std::size_t a = 0; a < all.members.size(); ++a)
      for (std::size_t b = a + 1; b < all.members.size(); ++b) {
        const auto& one = families[all.members[a].family].effect;
        const auto& two = families[all.members[b].family].effect;
        if (kind_of(one) == kind_of(two) || taken(one) || taken(two)) continue;
        const Index n = all.count[a], m = all.count[b];
        MatrixXd products(n + m, n + m);
        products << all.products.block(all.begin[a], all.begin[a], n, n),
            all.products.block(all.begin[a], all.begin[b], n, m),
            all.products.block(all.begin[b], all.begin[a], m, n),
            all.products.block(all.begin[b], all.begin[b], m, m);
        VectorXd right(n + m);
        right << all.with_data.segment(all.begin[a], n), all.with_data.segment(all.begin[b], m);
        const double value = explained(products, right) - penalty(all.members[a]) - penalty(all.members[b]);
        auto& entry = best_pairs.try_emplace({one, two}, Pair{-1.0, 0, 0}).first->second;
        if (value > entry.worth) entry = {value, a, b};
      }
    std::vector<Pair> sorted;
    for (const auto& [names, pair] : best_pairs)
      if (pair.worth > 0.0) sorted.push_back(pair);
    std::ranges::sort(sorted, [](const Pair& x, const Pair& y) { return x.worth > y.worth; });
    for (std::size_t i = 0; i < std::min(sorted.size(), kPairProposals); ++i) {
      Members more = set;
      const Member& b = all.members[sorted[i].b];
      const Member a = refined(all.members[sorted[i].a], {b}, noise);
      more.push_back(a);
      more.push_back(refined(b, {a}, noise));
      list.push_back(std::move(more));
    }
  }
  return list;
}

ScoredSet EffectSearch::pruned(ScoredSet set) {
  for (bool again = true; again && set.members.size() > 1;) {
    again = false;
    for (std::size_t i = 0; i < set.members.size(); ++i) {
      Members fewer = set.members;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      ScoredSet candidate = scored(std::move(fewer));
      if (candidate.score > set.score) continue;
      set = std::move(candidate);
      again = true;
      break;
    }
  }
  return set;
}

ScoredSet EffectSearch::worthy(ScoredSet set, std::vector<double>& without) {
  for (;;) {
    without.clear();
    std::size_t least = 0;
    std::vector<ScoredSet> fewer;
    for (std::size_t i = 0; i < set.members.size(); ++i) {
      Members others = set.members;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      fewer.push_back(scored(std::move(others)));
      without.push_back(fewer.back().score - set.score);
      if (without[i] < without[least]) least = i;
    }
    if (without.empty() || without[least] >= kWorth) return set;
    set = std::move(fewer[least]);
  }
}

std::vector<Rival> EffectSearch::rivals_of(const ScoredSet& best, std::size_t place) {
  Members others = best.members;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
  const auto& families = hypotheses_.families();
  const auto& mine = families[best.members[place].family].effect;
  const auto noise = hypotheses_.fit(best.members).noise;
  const Gains all = gains(others, noise);
  std::map<std::string, std::size_t> nearest;
  const auto worth = [&](std::size_t i) { return all.gain[i] - penalty(all.members[i]); };
  for (std::size_t i = 0; i < all.members.size(); ++i) {
    const auto& effect = families[all.members[i].family].effect;
    const bool taken = effect == mine || std::ranges::any_of(others, [&](const Member& m) {
                         return kind_of(families[m.family].effect) == kind_of(effect);
                       });
    if (taken) continue;
    const auto found = nearest.find(effect);
    if (found == nearest.end() || worth(i) > worth(found->second)) nearest[effect] = i;
  }
  std::vector<std::size_t> order;
  for (const auto& [effect, i] : nearest)
    if (worth(i) > 0.0) order.push_back(i);
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return worth(a) > worth(b); });
  std::vector<Rival> rivals;
  for (std::size_t i = 0; i < std::min(order.size(), kSingleProposals); ++i) {
    Members swapped = others;
    const Member rival = refined(all.members[order[i]], others, noise);
    swapped.push_back(rival);
    rivals.push_back({rival, scored(std::move(swapped)).score - best.score});
  }
  std::ranges::sort(rivals, [](const Rival& a, const Rival& b) { return a.gap < b.gap; });
  return rivals;
}

SearchResult EffectSearch::run() {
  SearchResult result;
  ScoredSet best = scored({});
  result.nothing = best.score;
  while (best.members.size() < kMostMembers) {
    ScoredSet next = best;
    for (auto& proposal : proposals(best.members, best.members.empty())) {
      ScoredSet candidate = pruned(scored(std::move(proposal)));
      if (candidate.score < next.score) next = std::move(candidate);
    }
    if (next.score >= best.score) break;
    best = std::move(next);
  }
  for (int swap = 0;; ++swap) {
    best = worthy(std::move(best), result.without);
    result.rivals.clear();
    for (std::size_t i = 0; i < best.members.size(); ++i) result.rivals.push_back(rivals_of(best, i));
    const auto better = swapped_for_the_better(best, result.rivals);
    if (!better || swap == kMostSwaps) break;
    best = *better;
  }
  result.best = std::move(best);
  return result;
}

}  // namespace hemi::diagnosis

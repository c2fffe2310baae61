// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/diagnosis/hypothesis.hpp"

namespace hemi::diagnosis {

/// What an effect must gain beyond its price to stay [-2 log likelihood].
inline constexpr double kWorth = 12.0;

/// A set of effects with what it costs: -2 log likelihood, and a penalty for every effect (choice among the
/// catalogue, its coefficients, its shapes).
struct ScoredSet {
  std::vector<Member> members;
  double score = 0.0;
};

/// What another effect in a member's place would cost more.
struct Rival {
  Member member;
  double gap = 0.0;
};

struct SearchResult {
  ScoredSet best;
  double nothing = 0.0;                    ///< score of the baseline alone
  std::vector<double> without;             ///< score of the set without each member, less the set's
  std::vector<std::vector<Rival>> rivals;  ///< of each member, nearest first
};

/// Set of effects of the catalogue that explains one recording best.
///
/// Effects are proposed by what they explain under the noise that is expected and under the noise that the
/// present set leaves, singly and in pairs, and judged by the likelihood with noise estimated again for each
/// set, so that a coloured noise competes with every effect. Members that others made superfluous go.
class EffectSearch {
 public:
  explicit EffectSearch(Hypotheses& hypotheses) : hypotheses_(hypotheses) {}

  SearchResult run();
  ScoredSet scored(std::vector<Member> members);
  /// The member with its shape moved to where it explains most beside `others`.
  Member refined(const Member& member, const std::vector<Member>& others, const Noise& noise);
  /// Gain of every grid point of every family beside a set, squares of the whitened residual; 0 where the
  /// coefficients are not possible.
  struct Gains {
    std::vector<Member> members;
    std::vector<double> gain;
    std::vector<Eigen::Index> begin, count;  ///< columns in products
    Eigen::MatrixXd products;                ///< of all columns, the set's own taken off
    Eigen::VectorXd with_data;
  };
  Gains gains(const std::vector<Member>& set, const Noise& noise);
  double penalty(const Member& member) const;

 private:
  double gain(const Member& member, const Eigen::MatrixXd& products, const Eigen::VectorXd& with_data) const;
  std::vector<std::vector<Member>> proposals(const std::vector<Member>& set, bool pairs);
  ScoredSet pruned(ScoredSet set);
  /// Without the members that are not worth kWorth; `without` of the rest.
  ScoredSet worthy(ScoredSet set, std::vector<double>& without);
  std::vector<Rival> rivals_of(const ScoredSet& best, std::size_t place);

  Hypotheses& hypotheses_;
};

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/earned_name.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "golden/diagnosis/effect_search.hpp"
#include "golden/diagnosis/form_error.hpp"
#include "golden/diagnosis/scaled_normal.hpp"
#include "golden/diagnosis/shaped_design.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double kNormal95 = 1.959963984540054;
constexpr double kDetectable = 5.0;
constexpr double kFarthestForm = 0.5;

VectorXd padded(const VectorXd& prior, Index size) {
  VectorXd result = VectorXd::Zero(size);
  result.head(prior.size()) = prior;
  return result;
}

// Of the resonator, from the case's.
double start_degc(const Hypotheses& h, const HypothesisFit& fit) {
  const auto start = std::ranges::find(h.baseline(), "start", &BaselineColumn::name);
  if (start == h.baseline().end()) return 0.0;
  return h.simulation().unsettled.start_degc + fit.coefficients[start - h.baseline().begin()];
}

}  // namespace

std::vector<std::vector<Interval>> intervals(Hypotheses& h, const std::vector<Member>& members,
                                             const HypothesisFit& fit) {
  const ShapedDesign all = shaped_design(h, members, fit);
  std::vector<std::size_t> each(members.size());
  std::iota(each.begin(), each.end(), 0U);
  const Reduced forms = form_directions(h, members, fit, each, kFarthestForm);
  const MatrixXd white = whiten(h.space(), fit.noise, joined({&all.rows, &forms}));
  VectorXd prior = padded(h.prior_precision(fit.coefficients.size()), white.cols());
  prior.tail(forms[0].cols()).setOnes();
  const MatrixXd covariance = ScaledNormal(white, prior).covariance();
  std::vector<std::vector<Interval>> list;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto& family = h.families()[members[m].family];
    std::vector<Interval> entries;
    if (!family.figures) {
      list.push_back(entries);
      continue;
    }
    const Index count = h.columns(members[m])[0].cols();
    const VectorXd c = fit.coefficients.segment(fit.first[m], count);
    const auto shapes = static_cast<Index>(family.spacing.size());
    std::vector<Index> places;
    for (Index i = 0; i < count; ++i) places.push_back(fit.first[m] + i);
    for (Index i = 0; i < shapes; ++i) places.push_back(all.shapes[m] + i);
    const MatrixXd own = covariance(places, places);
    const auto figures = [&](const VectorXd& move) {
      std::vector<double> coefficients(c.begin(), c.end()), shape = members[m].shape;
      for (Index i = 0; i < count; ++i) coefficients[static_cast<std::size_t>(i)] += move[i];
      for (Index i = 0; i < shapes; ++i) shape[static_cast<std::size_t>(i)] *= std::exp(move[count + i]);
      return family.figures(h.simulation(), coefficients, shape);
    };
    const auto centre = figures(VectorXd::Zero(count + shapes));
    MatrixXd gradient(static_cast<Index>(centre.size()), count + shapes);
    for (Index i = 0; i < count + shapes; ++i) {
      VectorXd move = VectorXd::Zero(count + shapes);
      const double step = 0.1 * std::sqrt(std::max(own(i, i), 1e-300));
      move[i] = i < count ? step : std::min(step, 0.05);
      const auto up = figures(move), down = figures(-move);
      for (std::size_t f = 0; f < centre.size(); ++f)
        gradient(static_cast<Index>(f), i) = (up[f].value - down[f].value) / (2.0 * move[i]);
    }
    const VectorXd variance = (gradient * own * gradient.transpose()).diagonal();
    for (std::size_t f = 0; f < centre.size(); ++f) {
      const double half = kNormal95 * std::sqrt(std::max(variance[static_cast<Index>(f)], 0.0));
      const double held = f == 0 && family.start_may_hold ? std::max(0.0, -start_degc(h, fit)) : 0.0;
      entries.push_back({centre[f], centre[f].value - half, centre[f].value + half + held, held});
    }
    list.push_back(std::move(entries));
  }
  return list;
}

Isolability isolability(Hypotheses& h, const Noise& noise) {
  Isolability result;
  EffectSearch search(h);
  const auto all = search.gains({}, noise);
  std::map<std::string, std::vector<std::size_t>> by_effect;
  for (std::size_t i = 0; i < all.members.size(); ++i)
    by_effect[h.families()[all.members[i].family].effect].push_back(i);
  std::map<std::string, Index> single;
  for (const auto& [effect, list] : by_effect) {
    // The middle of the grid stands for the form: a limit holds for a shape.
    const auto& first = h.families()[all.members[list[0]].family];
    const std::size_t i = list[std::min(first.grid.size(), list.size()) / 2];
    const auto& member = all.members[i];
    const auto& family = h.families()[member.family];
    const double square = all.products(all.begin[i], all.begin[i]);
    if (square <= 0.0) continue;
    single[effect] = all.begin[i];
    std::vector<double> c(static_cast<std::size_t>(all.count[i]), 0.0);
    c[0] = kDetectable / std::sqrt(square);
    DetectionLimit limit{effect, family.form, {}};
    if (family.figures) limit.smallest = family.figures(h.simulation(), c, member.shape);
    result.limits.push_back(std::move(limit));
  }
  for (auto a = single.begin(); a != single.end(); ++a)
    for (auto b = std::next(a); b != single.end(); ++b) {
      const double overlap =
          all.products(a->second, b->second) /
          std::sqrt(all.products(a->second, a->second) * all.products(b->second, b->second));
      if (std::abs(overlap) > std::sqrt(1.0 - 0.01)) result.pairs.push_back({a->first, b->first, overlap});
    }
  return result;
}

Decoys decoys(Hypotheses& h, const std::vector<Member>& members, const HypothesisFit& fit,
              std::uint64_t seed) {
  Decoys result;
  EffectSearch search(h);
  std::mt19937_64 random(seed);
  const MatrixXd own = whiten(h.space(), fit.noise, h.design(members));
  const VectorXd y = whiten(h.space(), fit.noise, h.data());
  const ScaledNormal solver(own, h.prior_precision(own.cols()));
  const VectorXd residual = y - own * solver.solve(own.transpose() * y);
  for (std::size_t f = 0; f < h.families().size(); ++f) {
    const Member member{f, h.families()[f].grid[h.families()[f].grid.size() / 2]};
    Reduced moved = h.columns(member);
    const double turn = std::uniform_real_distribution<double>(0.1, 0.9)(random);
    for (auto& rows : moved) {
      if (rows.rows() == 0) continue;
      const auto by = static_cast<Index>(turn * static_cast<double>(rows.rows()));
      MatrixXd copy(rows.rows(), rows.cols());
      copy << rows.bottomRows(rows.rows() - by), rows.topRows(by);
      rows = copy;
    }
    MatrixXd columns = whiten(h.space(), fit.noise, moved);
    for (Index j = 0; j < columns.cols(); ++j)
      columns.col(j) -= own * solver.solve(own.transpose() * columns.col(j));
    const VectorXd right = columns.transpose() * residual;
    MatrixXd normal = columns.transpose() * columns;
    normal.diagonal() *= 1.0 + 1e-9;
    normal.diagonal().array() += 1e-300;
    ++result.made;
    if (right.dot(normal.ldlt().solve(right)) > search.penalty(member)) ++result.accepted;
  }
  return result;
}

}  // namespace hemi::diagnosis

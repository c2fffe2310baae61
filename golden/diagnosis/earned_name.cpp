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

namespace hemi::diagnosis {
namespace {

using calibration::RowRange;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr Index kLeftOutFolds = 8;
constexpr Index kStretches =
    40;  // a fold is every eighth of them: the rest still spans the recording's range
// Innovations hardly depend on each other; and an effect may act in a few stretches alone.
constexpr Index kInnovations = 160;
constexpr double kNormal95 = 1.959963984540054;
constexpr double kDetectable = 5.0;
constexpr double kShapeStep = 0.01;
constexpr double kFarthestForm = 0.5;
constexpr double kShapeReach = 0.3;        // deviation of a shape's logarithm that a linear step can take
constexpr double kFarthestNuisance = 4.0;  // deviations of its prior

// Baseline, members' columns, then what a hundredth of each shape parameter changes, per unit of its log.
struct Extended {
  Reduced rows;
  std::vector<Index> shapes;  // first shape column of each member
};

Extended extended(Hypotheses& h, const std::vector<Member>& members, const HypothesisFit& fit) {
  Extended result;
  std::vector<Reduced> moved;
  Index next = fit.coefficients.size();
  for (std::size_t m = 0; m < members.size(); ++m) {
    result.shapes.push_back(next);
    const auto& family = h.families()[members[m].family];
    const Reduced& here = h.columns(members[m]);
    const VectorXd c = fit.coefficients.segment(fit.first[m], here[0].cols());
    for (std::size_t d = 0; d < family.spacing.size(); ++d, ++next) {
      Member other = members[m];
      other.shape[d] *= 1.0 + kShapeStep;
      const Reduced there = h.columns(other);
      Reduced column;
      for (std::size_t k = 0; k < kOutputs.size(); ++k)
        column[k] = (there[k] - here[k]) * c / std::log1p(kShapeStep);
      moved.push_back(std::move(column));
    }
  }
  const Reduced design = h.design(members);
  std::vector<const Reduced*> parts = {&design};
  for (const auto& column : moved) parts.push_back(&column);
  result.rows = joined(parts);
  return result;
}

VectorXd padded(const VectorXd& prior, Index size) {
  VectorXd result = VectorXd::Zero(size);
  result.head(prior.size()) = prior;
  return result;
}

// Block number of every stacked row.
std::vector<Index> block_numbers(const RowSpace& space) {
  std::vector<Index> numbers;
  for (const Output output : kOutputs)
    numbers.insert(numbers.end(), space.blocks(output).begin(), space.blocks(output).end());
  return numbers;
}

// Places of the stacked rows whose block is one of the kept.
template <typename Kept>
std::vector<Index> rows_where(const std::vector<Index>& block, const Kept& kept) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < block.size(); ++i)
    if (kept(block[i])) rows.push_back(static_cast<Index>(i));
  return rows;
}

Index fold_of(const RowSpace& space, Index block) {
  return block * kStretches / space.block_count() % kLeftOutFolds;
}

// Residuals of every row, the stretches of its fold left out of the fit: in units of the outputs, and
// innovations. These are taken with one set of parameters throughout: where a fold ends another's would jump.
struct LeftOut {
  Reduced residual;
  VectorXd white;
};

// Where the resonator began is the run's state, not a parameter: it is carried through as `whole` has it, as
// far as a nuisance can be (a lag of many samples is none). `whole` ends with the coefficients: the rest are
// shapes, and the step along them is linear.
LeftOut left_out(const Hypotheses& h, const Reduced& all, const Noise& noise, const VectorXd& whole) {
  const RowSpace& space = h.space();
  std::vector<Index> state, free;
  for (Index j = 0; j < all[0].cols(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    (k < h.baseline().size() && h.baseline()[k].nuisance ? state : free).push_back(j);
  }
  VectorXd at = whole(state);
  for (Index i = 0; i < at.size(); ++i) {
    const double deviation =
        h.baseline()[static_cast<std::size_t>(state[static_cast<std::size_t>(i)])].prior_sd;
    if (deviation > 0.0)
      at[i] = std::clamp(at[i], -kFarthestNuisance * deviation, kFarthestNuisance * deviation);
  }
  VectorXd prior = VectorXd::Zero(static_cast<Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i)
    if (free[i] >= whole.size()) prior[static_cast<Index>(i)] = 1.0 / (kShapeReach * kShapeReach);
  Reduced design, data = h.data();
  for (std::size_t k = 0; k < all.size(); ++k) {
    design[k] = all[k](Eigen::all, free);
    data[k].col(0) -= all[k](Eigen::all, state) * at;
  }
  const MatrixXd white = whiten(space, noise, design);
  const VectorXd y = whiten(space, noise, data);
  const auto numbers = block_numbers(space);
  LeftOut result{data, y};
  for (Index fold = 0; fold < kLeftOutFolds; ++fold) {
    const auto kept = rows_where(numbers, [&](Index block) { return fold_of(space, block) != fold; });
    const auto out = rows_where(numbers, [&](Index block) { return fold_of(space, block) == fold; });
    const MatrixXd rest = white(kept, Eigen::all);
    const VectorXd c = ScaledNormal(rest, prior).solve(rest.transpose() * VectorXd(y(kept)));
    result.white(out) -= white(out, Eigen::all) * c;
    for (const Output output : kOutputs) {
      const std::size_t k = place(output);
      const auto& blocks = space.blocks(output);
      for (std::size_t i = 0; i < blocks.size(); ++i)
        if (fold_of(space, blocks[i]) == fold)
          result.residual[k](static_cast<Index>(i), 0) -= design[k].row(static_cast<Index>(i)).dot(c);
    }
  }
  return result;
}

// Of the resonator, from the case's.
double start_degc(const Hypotheses& h, const HypothesisFit& fit) {
  const auto start = std::ranges::find(h.baseline(), "start", &BaselineColumn::name);
  if (start == h.baseline().end()) return 0.0;
  return h.simulation().unsettled.start_degc + fit.coefficients[start - h.baseline().begin()];
}

std::vector<RowRange> even_blocks(Index rows, Index most) {
  std::vector<RowRange> blocks;
  const Index count = std::min(most, rows);
  for (Index b = 0; b < count; ++b) {
    const Index begin = b * rows / count;
    blocks.push_back({begin, (b + 1) * rows / count - begin});
  }
  return blocks;
}

}  // namespace

std::vector<Improvement> improvements(Hypotheses& h, const std::vector<Member>& members,
                                      const HypothesisFit& fit) {
  std::vector<Improvement> list;
  const HypothesisFit baseline = h.fit({}, fit.noise);
  const LeftOut before = left_out(h, h.baseline_rows(), fit.noise, baseline.coefficients);
  const LeftOut after = left_out(h, extended(h, members, fit).rows, fit.noise, fit.coefficients);
  Index begin = 0;
  for (const Output output : kOutputs) {
    const std::size_t c = place(output);
    const bool acts =
        std::ranges::any_of(members, [&](const Member& m) { return h.columns(m)[c].squaredNorm() > 0.0; });
    const Index rows = h.space().rows(output);
    const Index first = begin;
    begin += rows;
    if (!acts || rows < kLeftOutFolds) continue;
    const auto blocks = even_blocks(rows, kStretches), short_blocks = even_blocks(rows, kInnovations);
    Improvement entry;
    entry.output = output;
    entry.train = bootstrap_gain(baseline.residual[c].col(0), fit.residual[c].col(0), blocks, 11);
    entry.held_out = bootstrap_gain(before.residual[c].col(0), after.residual[c].col(0), blocks, 12);
    entry.held_out_white =
        bootstrap_gain(before.white.segment(first, rows), after.white.segment(first, rows), short_blocks, 13);
    entry.floor_rms = std::sqrt(coloured_noise(h.expected()[c], h.space().block_count()).total_variance());
    list.push_back(entry);
  }
  return list;
}

std::vector<Gain> gains_left_out(Hypotheses& h, const std::vector<Member>& members, const HypothesisFit& fit,
                                 const std::vector<Output>& outputs) {
  const VectorXd after = left_out(h, extended(h, members, fit).rows, fit.noise, fit.coefficients).white;
  std::vector<Gain> gains;
  for (std::size_t i = 0; i < members.size(); ++i) {
    std::vector<Member> others = members;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const HypothesisFit rest = h.fit(others, fit.noise);
    const VectorXd before = left_out(h, extended(h, others, rest).rows, fit.noise, rest.coefficients).white;
    Index first = 0;
    for (std::size_t k = 0; k < place(outputs[i]); ++k) first += h.space().rows(kOutputs[k]);
    const Index rows = h.space().rows(outputs[i]);
    gains.push_back(bootstrap_gain(before.segment(first, rows), after.segment(first, rows),
                                   even_blocks(rows, kInnovations), 13));
  }
  return gains;
}

std::vector<std::vector<Interval>> intervals(Hypotheses& h, const std::vector<Member>& members,
                                             const HypothesisFit& fit) {
  const Extended all = extended(h, members, fit);
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

std::optional<double> halves_disagree(Hypotheses& h, const std::vector<Member>& members, std::size_t which,
                                      const HypothesisFit& fit) {
  const MatrixXd white = whiten(h.space(), fit.noise, h.design(members));
  const VectorXd y = whiten(h.space(), fit.noise, h.data());
  const auto numbers = block_numbers(h.space());
  const Index half = h.space().block_count() / 2;
  const Index first = fit.first[which], count = h.columns(members[which])[0].cols();
  std::array<VectorXd, 2> c;
  std::array<MatrixXd, 2> covariance;
  for (const bool early : {true, false}) {
    const auto kept = rows_where(numbers, [&](Index block) { return (block < half) == early; });
    const MatrixXd rows = white(kept, Eigen::all);
    const ScaledNormal solver(rows, h.prior_precision(white.cols()));
    const VectorXd all = solver.solve(rows.transpose() * VectorXd(y(kept)));
    c[early ? 0 : 1] = all.segment(first, count);
    covariance[early ? 0 : 1] = solver.covariance().block(first, first, count, count);
  }
  // What the halves say of the trace itself: coefficients that stand in for each other may differ.
  const MatrixXd own = white.middleCols(first, count);
  const MatrixXd products = own.transpose() * own;
  const VectorXd whole = fit.coefficients.segment(first, count), difference = c[0] - c[1];
  const double size = whole.dot(products * whole);
  const double noise = ((covariance[0] + covariance[1]) * products).trace();
  // A half that knows the trace to no better than its size says nothing of it.
  if (noise > size) return std::nullopt;
  return std::sqrt(difference.dot(products * difference) / std::max(noise, 0.01 * size));
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

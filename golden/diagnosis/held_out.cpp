// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/held_out.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "golden/diagnosis/scaled_normal.hpp"
#include "golden/diagnosis/shaped_design.hpp"

namespace hemi::diagnosis {
namespace {

using calibration::RowRange;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr Index kLeftOutFolds = 8;
// A fold is every eighth of them: the rest still spans the recording's range.
constexpr Index kStretches = 40;
// Innovations hardly depend on each other; and an effect may act in a few stretches alone.
constexpr Index kInnovations = 160;
constexpr double kShapeReach = 0.3;        // deviation of a shape's logarithm that a linear step can take
constexpr double kFarthestNuisance = 4.0;  // deviations of its prior

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

std::vector<RowRange> even_blocks(Index rows, Index most) {
  std::vector<RowRange> blocks;
  const Index count = std::min(most, rows);
  for (Index b = 0; b < count; ++b) {
    const Index begin = b * rows / count;
    blocks.push_back({begin, (b + 1) * rows / count - begin});
  }
  return blocks;
}

// Where each output's rows begin among the stacked ones.
Index first_row(const RowSpace& space, Output output) {
  Index first = 0;
  for (std::size_t k = 0; k < place(output); ++k) first += space.rows(kOutputs[k]);
  return first;
}

std::vector<Improvement> improvements(Hypotheses& h, const std::vector<Member>& members,
                                      const HypothesisFit& fit, const HypothesisFit& baseline,
                                      const LeftOut& after) {
  std::vector<Improvement> list;
  const LeftOut before = left_out(h, h.baseline_rows(), fit.noise, baseline.coefficients);
  for (const Output output : kOutputs) {
    const std::size_t c = place(output);
    const bool acts =
        std::ranges::any_of(members, [&](const Member& m) { return h.columns(m)[c].squaredNorm() > 0.0; });
    const Index rows = h.space().rows(output), first = first_row(h.space(), output);
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

Gain gain_of_one(Hypotheses& h, const std::vector<Member>& members, const HypothesisFit& fit,
                 std::size_t which, Output judged, const VectorXd& after) {
  std::vector<Member> others = members;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(which));
  const HypothesisFit rest = h.fit(others, fit.noise);
  const VectorXd before =
      left_out(h, shaped_design(h, others, rest).rows, fit.noise, rest.coefficients).white;
  const Index rows = h.space().rows(judged), first = first_row(h.space(), judged);
  return bootstrap_gain(before.segment(first, rows), after.segment(first, rows),
                        even_blocks(rows, kInnovations), 13);
}

}  // namespace

HeldOut held_out(Hypotheses& h, const std::vector<Member>& members, const HypothesisFit& fit,
                 const HypothesisFit& baseline, const std::vector<Output>& judged) {
  const LeftOut after = left_out(h, shaped_design(h, members, fit).rows, fit.noise, fit.coefficients);
  HeldOut result{improvements(h, members, fit, baseline, after), {}};
  if (members.size() > 1)
    for (std::size_t i = 0; i < members.size(); ++i)
      result.alone.push_back(gain_of_one(h, members, fit, i, judged[i], after.white));
  return result;
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

}  // namespace hemi::diagnosis

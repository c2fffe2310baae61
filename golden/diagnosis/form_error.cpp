// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/form_error.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "golden/diagnosis/scaled_normal.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr std::size_t kMostForms = 24;
constexpr Index kMostDirections = 8;

// Forms and shapes of one effect, thinned to kMostForms.
std::vector<Member> forms_of(const Hypotheses& h, const std::string& effect) {
  std::vector<Member> all;
  for (std::size_t f = 0; f < h.families().size(); ++f)
    if (h.families()[f].effect == effect)
      for (const auto& shape : h.families()[f].grid) all.push_back({f, shape});
  std::vector<Member> kept;
  const std::size_t each = (all.size() + kMostForms - 1) / kMostForms;
  for (std::size_t i = 0; i < all.size(); i += each) kept.push_back(all[i]);
  return kept;
}

// Columns that match `trace` best beside `own`: coefficients of `columns` alone.
VectorXd matched(const MatrixXd& own, const MatrixXd& columns, const VectorXd& trace) {
  MatrixXd all(own.rows(), own.cols() + columns.cols());
  all << own, columns;
  return ScaledNormal(all, VectorXd::Zero(all.cols()), 1e-9)
      .solve(all.transpose() * trace)
      .bottomRows(columns.cols());
}

Reduced times(const Reduced& columns, const MatrixXd& by) {
  Reduced result;
  for (std::size_t c = 0; c < columns.size(); ++c) result[c] = columns[c] * by;
  return result;
}

}  // namespace

Reduced form_directions(Hypotheses& h, const std::vector<Member>& members, const HypothesisFit& fit,
                        const std::vector<std::size_t>& which, double farthest) {
  const RowSpace& space = h.space();
  const MatrixXd own = whiten(space, fit.noise, h.baseline_rows());
  const MatrixXd q = own.colPivHouseholderQr().householderQ() * MatrixXd::Identity(own.rows(), own.cols());
  // What the baseline takes of a difference is no difference.
  const auto beside_baseline = [&](const Reduced& columns) -> MatrixXd {
    const MatrixXd white = whiten(space, fit.noise, columns);
    return white - q * (q.transpose() * white);
  };
  std::vector<Reduced> differences;
  for (const std::size_t m : which) {
    const Reduced& mine = h.columns(members[m]);
    const Reduced trace = times(mine, fit.coefficients.segment(fit.first[m], mine[0].cols()));
    const VectorXd white = whiten(space, fit.noise, trace).col(0);
    const double size = beside_baseline(trace).norm();
    const auto forms = forms_of(h, h.families()[members[m].family].effect);
    const double prior = 1.0 / std::sqrt(static_cast<double>(forms.size()));
    for (const auto& form : forms) {
      if (form == members[m]) continue;
      const Reduced& columns = h.columns(form);
      Reduced other = times(columns, matched(own, whiten(space, fit.noise, columns), white));
      for (std::size_t c = 0; c < other.size(); ++c) other[c] -= trace[c];
      if (beside_baseline(other).norm() > farthest * size) continue;
      for (auto& rows : other) rows *= prior;
      differences.push_back(std::move(other));
    }
  }
  Reduced none;
  for (const Output output : kOutputs) none[place(output)].resize(space.rows(output), 0);
  if (differences.empty()) return none;
  std::vector<const Reduced*> parts;
  for (const auto& each : differences) parts.push_back(&each);
  const Reduced all = joined(parts);
  const MatrixXd white = beside_baseline(all);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(white.transpose() * white);
  const Index n = axes.eigenvalues().size();
  Index count = 0;
  while (count < std::min(n, kMostDirections) && axes.eigenvalues()[n - 1 - count] > 1.0) ++count;
  return times(all, axes.eigenvectors().rightCols(count));
}

double gain_beside_forms(Hypotheses& h, const std::vector<Member>& members, const HypothesisFit& fit,
                         std::size_t which) {
  std::vector<std::size_t> others;
  std::vector<Member> rest;
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (m == which) continue;
    others.push_back(m);
    rest.push_back(members[m]);
  }
  const Reduced forms = form_directions(h, members, fit, others);
  const Reduced design = h.design(rest);
  const Index known = design[0].cols();
  const MatrixXd own = whiten(h.space(), fit.noise, joined({&design, &forms}));
  VectorXd prior = VectorXd::Ones(own.cols());
  prior.head(known) = h.prior_precision(known);
  const Reduced& mine = h.columns(members[which]);
  MatrixXd columns = whiten(h.space(), fit.noise, joined({&mine, &h.data()}));
  const MatrixXd right = own.transpose() * columns;
  const MatrixXd left =
      columns.transpose() * columns - right.transpose() * ScaledNormal(own, prior).solve(right);
  const Index n = mine[0].cols();
  const VectorXd with_data = left.col(n).head(n);
  return with_data.dot(VectorXd(ScaledNormal::of_products(left.topLeftCorner(n, n), 1e-9).solve(with_data)));
}

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "golden/rivals/methods.hpp"
#include "golden/rivals/regression.hpp"

namespace hemi::rivals {
namespace {

struct Column {
  Eigen::VectorXd values;
  std::string id;
};

/// Candidates' columns less what the base explains, each of unit deviation: STLSQ on what the base leaves.
std::vector<Column> scaled_columns(const Problem& problem) {
  std::vector<Column> columns;
  for (const Candidate& candidate : problem.candidates) {
    for (Eigen::Index k = 0; k < candidate.columns.cols(); ++k) {
      const Eigen::VectorXd column = candidate.columns.col(k);
      const Regression base = regress(problem.base, column);
      const Eigen::VectorXd rest = column - problem.base * base.coefficients;
      const double deviation = std::sqrt(rest.squaredNorm() / static_cast<double>(rest.size()));
      if (deviation > 1e-6 * (1e-12 + column.cwiseAbs().maxCoeff()))
        columns.push_back({rest / deviation, candidate.id});
    }
  }
  return columns;
}

struct Support {
  std::vector<std::size_t> members;
  Eigen::VectorXd coefficients;
  double squares = 0.0;
};

Support thresholded(const std::vector<Column>& columns, const Eigen::VectorXd& values, double threshold) {
  Support support;
  for (std::size_t k = 0; k < columns.size(); ++k) support.members.push_back(k);
  for (int pass = 0; pass < 20; ++pass) {
    Eigen::MatrixXd matrix(values.size(), static_cast<Eigen::Index>(support.members.size()));
    for (std::size_t k = 0; k < support.members.size(); ++k)
      matrix.col(static_cast<Eigen::Index>(k)) = columns[support.members[k]].values;
    if (support.members.empty()) {
      support.squares = values.squaredNorm();
      return support;
    }
    const Regression fit = regress(matrix, values);
    support.coefficients = fit.coefficients;
    support.squares = fit.squares;
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < support.members.size(); ++k)
      if (std::abs(fit.coefficients[static_cast<Eigen::Index>(k)]) >= threshold)
        kept.push_back(support.members[k]);
    if (kept.size() == support.members.size()) return support;
    support.members = kept;
  }
  return support;
}

}  // namespace

Names sparse(const std::vector<Problem>& problems) {
  std::vector<std::pair<double, std::string>> found;
  for (const Problem& problem : problems) {
    const auto columns = scaled_columns(problem);
    const Regression base = regress(problem.base, problem.misfit);
    const Eigen::VectorXd rest = problem.misfit - problem.base * base.coefficients;
    const double n = static_cast<double>(rest.size()), deviation = std::sqrt(rest.squaredNorm() / n);
    if (deviation == 0.0) continue;
    Support best;
    double best_criterion = n * std::log(rest.squaredNorm() / n);
    for (int step = 0; step < 24; ++step) {
      const Support support = thresholded(columns, rest, deviation * std::pow(10.0, -3.0 + 0.13 * step));
      const double criterion = n * std::log(std::max(support.squares, 1e-300) / n) +
                               2.0 * static_cast<double>(support.members.size());
      if (criterion >= best_criterion) continue;
      best_criterion = criterion;
      best = support;
    }
    for (std::size_t k = 0; k < best.members.size(); ++k)
      found.emplace_back(std::abs(best.coefficients[static_cast<Eigen::Index>(k)]) / deviation,
                         columns[best.members[k]].id);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Names names;
  for (const auto& [weight, id] : found)
    if (std::find(names.begin(), names.end(), id) == names.end()) names.push_back(id);
  return names;
}

}  // namespace hemi::rivals

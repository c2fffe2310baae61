// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "golden/rivals/methods.hpp"
#include "golden/rivals/regression.hpp"

namespace hemi::rivals {
namespace {

constexpr double kEnter = 0.01, kLeave = 0.05;

Eigen::MatrixXd with(const Problem& problem, const std::vector<std::size_t>& members) {
  Eigen::Index width = problem.base.cols();
  for (const std::size_t m : members) width += problem.candidates[m].columns.cols();
  Eigen::MatrixXd all(problem.base.rows(), width);
  all.leftCols(problem.base.cols()) = problem.base;
  Eigen::Index at = problem.base.cols();
  for (const std::size_t m : members) {
    const auto& columns = problem.candidates[m].columns;
    all.middleCols(at, columns.cols()) = columns;
    at += columns.cols();
  }
  return all;
}

Regression fit(const Problem& problem, const std::vector<std::size_t>& members) {
  return regress(with(problem, members), problem.misfit);
}

std::vector<std::size_t> without(const std::vector<std::size_t>& members, std::size_t which) {
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < members.size(); ++i)
    if (i != which) rest.push_back(members[i]);
  return rest;
}

/// The candidate that raises F most; false where none passes.
bool enter(const Problem& problem, std::vector<std::size_t>& members) {
  const Eigen::Index n = problem.misfit.size();
  const Regression now = fit(problem, members);
  double best = 0.0;
  std::size_t chosen = problem.candidates.size();
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    if (std::find(members.begin(), members.end(), c) != members.end()) continue;
    auto more = members;
    more.push_back(c);
    const Regression next = fit(problem, more);
    const double gain = bic(now, n) - bic(next, n);
    if (gain > best && f_test(now, next, n) < kEnter) {
      best = gain;
      chosen = c;
    }
  }
  if (chosen == problem.candidates.size()) return false;
  members.push_back(chosen);
  return true;
}

void leave(const Problem& problem, std::vector<std::size_t>& members) {
  const Eigen::Index n = problem.misfit.size();
  for (std::size_t i = 0; i < members.size();) {
    const auto fewer = without(members, i);
    if (f_test(fit(problem, fewer), fit(problem, members), n) > kLeave)
      members = fewer;
    else
      ++i;
  }
}

}  // namespace

Names stepwise(const std::vector<Problem>& problems) {
  std::vector<std::pair<double, std::string>> found;
  for (const Problem& problem : problems) {
    std::vector<std::size_t> members;
    // A member that left may not come back for ever: as many steps as there are candidates.
    for (std::size_t step = 0; step < problem.candidates.size() && enter(problem, members); ++step)
      leave(problem, members);
    const Eigen::Index n = problem.misfit.size();
    for (std::size_t i = 0; i < members.size(); ++i) {
      const auto fewer = without(members, i);
      found.emplace_back(bic(fit(problem, fewer), n) - bic(fit(problem, members), n),
                         problem.candidates[members[i]].id);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Names names;
  for (const auto& [gain, id] : found)
    if (std::find(names.begin(), names.end(), id) == names.end()) names.push_back(id);
  return names;
}

}  // namespace hemi::rivals

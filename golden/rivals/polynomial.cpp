// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <utility>

#include "golden/rivals/methods.hpp"
#include "golden/rivals/regression.hpp"

namespace hemi::rivals {

Names polynomial(const std::vector<Problem>& problems) {
  // What higher powers of temperature mean in each channel; in the rate they are no physics of their own.
  static const std::map<std::string, std::string> kMeaning{{"frequency_hz", "frequency_polynomial_order"},
                                                           {"drive_v", "damping_temperature"},
                                                           {"quadrature_v", "frequency_split"},
                                                           {"rate_dph", "thermal_hysteresis"}};
  std::vector<std::pair<double, std::string>> found;
  for (const Problem& problem : problems) {
    const Eigen::VectorXd t = problem.inputs.col(0);
    const double half = std::max(0.5 * (t.maxCoeff() - t.minCoeff()), 1e-6);
    const Eigen::ArrayXd x = (t.array() - t.mean()) / half;
    Eigen::MatrixXd more(problem.base.rows(), problem.base.cols() + 6);
    more.leftCols(problem.base.cols()) = problem.base;
    for (int k = 0; k < 6; ++k) more.col(problem.base.cols() + k) = x.pow(k + 1.0).matrix();
    const Eigen::Index n = problem.misfit.size();
    const Regression part = regress(problem.base, problem.misfit), full = regress(more, problem.misfit);
    if (f_test(part, full, n) < 0.01)
      found.emplace_back(bic(part, n) - bic(full, n), kMeaning.at(problem.channel));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Names names;
  for (const auto& one : found) names.push_back(one.second);
  return names;
}

}  // namespace hemi::rivals

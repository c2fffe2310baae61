// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "golden/rivals/methods.hpp"
#include "golden/rivals/regression.hpp"

namespace hemi::rivals {
namespace {

/// Rows averaged down to `points`, inputs of unit deviation, the misfit less its base and of unit deviation.
struct Sample {
  Eigen::MatrixXd inputs;
  Eigen::VectorXd values;
  std::vector<std::size_t> used;  ///< inputs that vary
};

Sample sample(const Problem& problem, int points) {
  const Regression base = regress(problem.base, problem.misfit);
  const Eigen::VectorXd rest = problem.misfit - problem.base * base.coefficients;
  const Eigen::Index group = std::max<Eigen::Index>(1, rest.size() / points), n = rest.size() / group;
  Sample result;
  result.values.resize(n);
  Eigen::MatrixXd inputs(n, problem.inputs.cols());
  for (Eigen::Index i = 0; i < n; ++i) {
    result.values[i] = rest.segment(i * group, group).mean();
    inputs.row(i) = problem.inputs.middleRows(i * group, group).colwise().mean();
  }
  result.values.array() -= result.values.mean();
  result.values /= std::max(std::sqrt(result.values.squaredNorm() / static_cast<double>(n)), 1e-300);
  std::vector<Eigen::VectorXd> columns;
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    Eigen::VectorXd column = inputs.col(k).array() - inputs.col(k).mean();
    const double deviation = std::sqrt(column.squaredNorm() / static_cast<double>(n));
    if (deviation <= 1e-4 * (1e-9 + inputs.col(k).cwiseAbs().maxCoeff())) continue;
    columns.emplace_back(column / deviation);
    result.used.push_back(static_cast<std::size_t>(k));
  }
  result.inputs.resize(n, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    result.inputs.col(static_cast<Eigen::Index>(k)) = columns[k];
  return result;
}

/// Logarithms of: inverse squared lengths, signal variance, noise variance.
double log_likelihood(const Sample& data, const Eigen::VectorXd& hyper) {
  const Eigen::Index n = data.values.size(), d = data.inputs.cols();
  const Eigen::MatrixXd scaled = data.inputs * (0.5 * hyper.head(d)).array().exp().matrix().asDiagonal();
  const Eigen::VectorXd norms = scaled.rowwise().squaredNorm();
  Eigen::MatrixXd covariance = -scaled * scaled.transpose();
  covariance.colwise() += 0.5 * norms;
  covariance.rowwise() += 0.5 * norms.transpose();
  covariance = (std::exp(hyper[d]) * (-covariance.array()).exp()).matrix();
  covariance.diagonal().array() += std::exp(hyper[d + 1]) + 1e-8;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) return -1e300;
  const Eigen::VectorXd white = factor.matrixL().solve(data.values);
  const Eigen::MatrixXd lower = factor.matrixL();
  return -0.5 * white.squaredNorm() - lower.diagonal().array().log().sum() -
         0.5 * static_cast<double>(n) * std::log(2.0 * 3.14159265358979323846);
}

/// Coordinate search with steps that shrink.
double maximise(const Sample& data, Eigen::VectorXd& hyper) {
  double best = log_likelihood(data, hyper);
  for (double step = 2.0; step > 0.2; step *= 0.5) {
    for (Eigen::Index k = 0; k < hyper.size(); ++k) {
      for (const double direction : {step, -step}) {
        Eigen::VectorXd moved = hyper;
        moved[k] = std::clamp(moved[k] + direction, -14.0, 8.0);
        const double value = log_likelihood(data, moved);
        if (value <= best) continue;
        best = value;
        hyper = moved;
      }
    }
  }
  return best;
}

std::string meaning(const std::string& channel, const std::string& input) {
  static const std::map<std::pair<std::string, std::string>, std::string> kMeaning{
      {{"frequency_hz", "T"}, "frequency_polynomial_order"},
      {{"frequency_hz", "dT"}, "thermal_second_time_constant"},
      {{"frequency_hz", "t"}, "frequency_ageing"},
      {{"frequency_hz", "Tb"}, "oscillator_temperature"},
      {{"frequency_hz", "A"}, "duffing"},
      {{"frequency_hz", "V"}, "electrostatic_softening"},
      {{"drive_v", "T"}, "damping_temperature"},
      {{"drive_v", "t"}, "gas_leak"},
      {{"drive_v", "Tb"}, "pickoff_gain"},
      {{"drive_v", "A"}, "damping_nonlinearity"},
      {{"quadrature_v", "T"}, "frequency_split"},
      {{"quadrature_v", "t"}, "frequency_split"},
      {{"rate_dph", "T"}, "thermal_hysteresis"},
      {{"rate_dph", "dT"}, "thermal_gradient_bias"},
      {{"rate_dph", "t"}, "rate_random_walk"},
      {{"rate_dph", "Tb"}, "demodulation_phase"},
      {{"rate_dph", "A"}, "forcer_misalignment"},
      {{"rate_dph", "W"}, "scale_factor_nonlinearity"},
      {{"rate_dph", "a"}, "g_sensitivity"},
      {{"rate_dph", "Q"}, "demodulation_phase"}};
  const auto found = kMeaning.find({channel, input});
  return found == kMeaning.end() ? "unknown" : found->second;
}

}  // namespace

Names gaussian_process(const std::vector<Problem>& problems, int points) {
  std::vector<std::pair<double, std::string>> found;
  for (const Problem& problem : problems) {
    const Sample data = sample(problem, points);
    const Eigen::Index d = data.inputs.cols();
    if (d == 0) continue;
    Eigen::VectorXd hyper = Eigen::VectorXd::Constant(d + 2, -3.0);
    hyper[d] = hyper[d + 1] = -0.7;
    Eigen::VectorXd silent = Eigen::VectorXd::Constant(d + 2, -14.0);
    silent[d + 1] = 0.0;
    const double n = static_cast<double>(data.values.size());
    const double gain = maximise(data, hyper) - log_likelihood(data, silent);
    if (gain < std::log(n) * static_cast<double>(d + 1)) continue;
    Eigen::Index relevant = 0;
    hyper.head(d).maxCoeff(&relevant);
    const std::string id = meaning(problem.channel, kInputs[data.used[static_cast<std::size_t>(relevant)]]);
    found.emplace_back(gain, id);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Names names;
  for (const auto& [gain, id] : found)
    if (std::find(names.begin(), names.end(), id) == names.end()) names.push_back(id);
  return names;
}

}  // namespace hemi::rivals

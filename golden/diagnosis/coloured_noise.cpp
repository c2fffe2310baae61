// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/coloured_noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTimeRatio = 6.0;
constexpr double kShortest = 0.5;  // blocks
// Longer than the recording by this much a process is a walk within it.
constexpr double kWalkLengths = 30.0;
// Of a part to the white one.
constexpr double kLeastRatio = 1e-7, kMostRatio = 8000.0;
constexpr int kRatioBits = 12;  // of the logarithm of a ratio: far finer than the likelihood can tell

// Gains and innovation variances of every row; they do not depend on the data. A row tells something of its
// own block's step of a walk as well: the walk is carried on to the block's end.
struct Filter {
  MatrixXd gain;       // process x row
  VectorXd deviation;  // of the innovation
  double log_determinant = 0.0;
};

Filter make_filter(const std::vector<Index>& blocks, const ColouredNoise& noise) {
  const Index n = noise.variance.size(), rows = static_cast<Index>(blocks.size());
  Filter filter{MatrixXd(n, rows), VectorXd(rows), 0.0};
  const VectorXd& a = noise.correlation;
  const VectorXd drive = noise.variance.array() * (1.0 - a.array().square());
  const double step = noise.walk_step;
  MatrixXd p = noise.variance.asDiagonal();
  for (Index t = 0; t < rows; ++t) {
    const Index skipped =
        t == 0 ? 0 : blocks[static_cast<std::size_t>(t)] - blocks[static_cast<std::size_t>(t - 1)];
    for (Index k = 0; k < skipped; ++k) {
      p = a.asDiagonal() * p * a.asDiagonal();
      p.diagonal() += drive;
      if (step > 0.0 && k == 0) p(n - 1, n - 1) -= drive[n - 1];  // taken along by the row before
    }
    VectorXd covariance = p.rowwise().sum();
    const double variance = covariance.sum() + step / 3.0 + noise.white;
    if (step > 0.0) {
      covariance[n - 1] += 0.5 * step;
      p(n - 1, n - 1) += step;
    }
    filter.gain.col(t) = covariance / variance;
    filter.deviation[t] = std::sqrt(variance);
    filter.log_determinant += std::log(variance);
    p -= covariance * covariance.transpose() / variance;
  }
  return filter;
}

}  // namespace

VectorXd flicker_correlations(Index blocks) {
  std::vector<double> list;
  for (double time = kShortest; time < 3.0 * static_cast<double>(blocks); time *= kTimeRatio)
    list.push_back(std::exp(-1.0 / time));
  return VectorXd::Map(list.data(), static_cast<Index>(list.size()));
}

double walk_correlation(Index blocks) {
  return std::exp(-1.0 / (kWalkLengths * static_cast<double>(blocks)));
}

ColouredNoise coloured_noise(const NoiseShape& shape, Index blocks) {
  std::vector<double> variance, correlation;
  if (shape.behind > 0.0) {
    variance.push_back(shape.behind);
    correlation.push_back(shape.behind_correlation);
  }
  if (shape.flicker > 0.0)
    for (const double a : flicker_correlations(blocks)) {
      variance.push_back(shape.flicker);
      correlation.push_back(a);
    }
  if (shape.walk > 0.0) {
    const double a = walk_correlation(blocks);
    variance.push_back(shape.walk * a * a / (1.0 - a * a));
    correlation.push_back(a);
  }
  const auto count = static_cast<Index>(variance.size());
  return {shape.white, VectorXd::Map(variance.data(), count), VectorXd::Map(correlation.data(), count),
          shape.walk};
}

MatrixXd whiten(const MatrixXd& rows, const std::vector<Index>& blocks, const ColouredNoise& noise,
                double* log_determinant) {
  const Filter filter = make_filter(blocks, noise);
  if (log_determinant != nullptr) *log_determinant = filter.log_determinant;
  MatrixXd white(rows.rows(), rows.cols());
  const Index n = noise.variance.size();
  // All columns at once: the state has a row a column.
  MatrixXd state = MatrixXd::Zero(rows.cols(), n);
  VectorXd innovation(rows.cols());
  for (Index t = 0; t < rows.rows(); ++t) {
    const Index skipped =
        t == 0 ? 0 : blocks[static_cast<std::size_t>(t)] - blocks[static_cast<std::size_t>(t - 1)];
    if (skipped == 1)
      state = state * noise.correlation.asDiagonal();
    else if (skipped > 1)
      state = state * noise.correlation.array().pow(static_cast<double>(skipped)).matrix().asDiagonal();
    innovation = rows.row(t).transpose();
    if (n > 0) {
      innovation -= state.rowwise().sum();
      state.noalias() += innovation * filter.gain.col(t).transpose();
    }
    white.row(t) = innovation.transpose() / filter.deviation[t];
  }
  return white;
}

double restricted_likelihood(const MatrixXd& x, const VectorXd& y, const std::vector<Index>& blocks,
                             const NoiseShape& shape, double* scale) {
  MatrixXd z(x.rows(), x.cols() + 1);
  z << x, y;
  double log_determinant = 0.0;
  const MatrixXd white =
      whiten(z, blocks, coloured_noise(shape, blocks.empty() ? 1 : blocks.back() + 1), &log_determinant);
  const MatrixXd gram = white.transpose() * white;
  const Index k = x.cols();
  const Eigen::LLT<MatrixXd> factor(gram.topLeftCorner(k, k));
  const VectorXd cross = gram.col(k).head(k);
  const double squares = std::max(gram(k, k) - cross.dot(factor.solve(cross)), 1e-300);
  const double freedom = static_cast<double>(y.size() - k);
  if (scale != nullptr) *scale = squares / freedom;
  return log_determinant + 2.0 * MatrixXd(factor.matrixL()).diagonal().array().log().sum() +
         freedom * std::log(squares / freedom);
}

NoiseShape fit_noise_shape(const MatrixXd& x, const VectorXd& y, const std::vector<Index>& blocks,
                           const NoiseShape& expected) {
  const double price = std::log(static_cast<double>(y.size()));
  NoiseShape shape;
  shape.flicker = expected.flicker / expected.white;
  shape.walk = expected.walk / expected.white;
  shape.behind_correlation = expected.behind_correlation;
  const NoiseShape least = shape;
  const auto value = [&](const NoiseShape& s) { return restricted_likelihood(x, y, blocks, s, nullptr); };
  double now = value(shape);
  using Part = double NoiseShape::*;
  const auto fit_part = [&](NoiseShape at, Part part, double& found) {
    const auto best = boost::math::tools::brent_find_minima(
        [&](double log_ratio) {
          at.*part = std::exp(log_ratio);
          return value(at);
        },
        std::log(std::max(least.*part, kLeastRatio)), std::log(kMostRatio), kRatioBits);
    at.*part = std::exp(best.first);
    found = best.second;
    return at;
  };
  std::vector<Part> open = {&NoiseShape::flicker, &NoiseShape::walk};
  if (expected.behind_correlation > 0.0) open.insert(open.begin(), &NoiseShape::behind);
  std::vector<Part> kept;
  while (!open.empty()) {
    std::size_t best_part = open.size();
    double best = now - price;
    NoiseShape best_shape = shape;
    for (std::size_t i = 0; i < open.size(); ++i) {
      double found = 0.0;
      const NoiseShape tried = fit_part(shape, open[i], found);
      if (found >= best) continue;
      best = found;
      best_part = i;
      best_shape = tried;
    }
    if (best_part == open.size()) break;
    shape = best_shape;
    now = best;
    kept.push_back(open[best_part]);
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(best_part));
    // The parts that were there before settle beside the new one.
    for (const Part part : kept) {
      double found = 0.0;
      if (kept.size() == 1) break;
      const NoiseShape tried = fit_part(shape, part, found);
      if (found < now) {
        shape = tried;
        now = found;
      }
    }
  }
  double scale = 1.0;
  restricted_likelihood(x, y, blocks, shape, &scale);
  shape.white *= scale;
  shape.flicker *= scale;
  shape.walk *= scale;
  shape.behind *= scale;
  return shape;
}

}  // namespace hemi::diagnosis

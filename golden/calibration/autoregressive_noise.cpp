// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/autoregressive_noise.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace hemi::calibration {
namespace {

// One-step predictors of every order up to p, and their error variances in units of the innovation's.
struct Predictors {
  std::vector<Eigen::VectorXd> coefficients;  // of order 0..p
  std::vector<double> variance;               // of order 0..p; the last is 1
};

Predictors durbin_levinson(const Eigen::VectorXd& partial) {
  const Eigen::Index order = partial.size();
  Predictors result;
  result.coefficients.emplace_back(Eigen::VectorXd(0));
  double variance = 1.0 / (1.0 - partial.array().square()).prod();
  result.variance.push_back(variance);
  for (Eigen::Index i = 0; i < order; ++i) {
    const Eigen::VectorXd& previous = result.coefficients.back();
    Eigen::VectorXd next(i + 1);
    next.head(i) = previous - partial(i) * previous.reverse();
    next(i) = partial(i);
    variance *= 1.0 - partial(i) * partial(i);
    result.coefficients.push_back(std::move(next));
    result.variance.push_back(variance);
  }
  return result;
}

// Beyond this a correlation time exceeds ten thousand samples and the data say nothing more about it.
constexpr double kMaxTransformed = 5.0;
// Step of the numerical derivatives: the likelihood's curvature changes by (step)^2 over it, and its rounding
// noise of about 1e-10 stays far below curvature times step squared.
constexpr double kStep = 2e-3;

// Restricted likelihood: -2 log L up to a constant, as a function of theta = atanh(partial) and log variance.
class RestrictedLikelihood {
 public:
  explicit RestrictedLikelihood(const LaggedProducts& products) : products_(products) {}

  struct Parts {
    double residual_square;
    double log_determinants;
    double dof;
  };

  Parts parts(const Eigen::VectorXd& theta) const {
    const Eigen::VectorXd partial = theta.array().tanh();
    const Eigen::MatrixXd gram = products_.gram(partial);
    const Eigen::Index columns = gram.cols() - 1;
    const Eigen::LLT<Eigen::MatrixXd> factor(gram.topLeftCorner(columns, columns));
    const Eigen::VectorXd projected = factor.matrixL().solve(gram.col(columns).head(columns));
    const double residual_square = gram(columns, columns) - projected.squaredNorm();
    const Eigen::MatrixXd lower = factor.matrixL();
    return {std::max(residual_square, std::numeric_limits<double>::min()),
            2.0 * lower.diagonal().array().log().sum() + products_.log_determinant(partial),
            static_cast<double>(products_.rows() - columns)};
  }

  // Variance profiled out.
  double profile(const Eigen::VectorXd& theta) const {
    const Parts p = parts(theta);
    return p.dof * std::log(p.residual_square / p.dof) + p.log_determinants;
  }

  // (theta, log variance).
  double full(const Eigen::VectorXd& parameters) const {
    const Parts p = parts(parameters.head(parameters.size() - 1));
    const double log_variance = parameters(parameters.size() - 1);
    return p.dof * log_variance + p.residual_square * std::exp(-log_variance) + p.log_determinants;
  }

 private:
  const LaggedProducts& products_;
};

template <typename Function>
void differentiate(const Function& function, const Eigen::VectorXd& at, Eigen::VectorXd& gradient,
                   Eigen::MatrixXd& hessian) {
  const Eigen::Index size = at.size();
  gradient.resize(size);
  hessian.resize(size, size);
  const double centre = function(at);
  Eigen::VectorXd plus(size);
  Eigen::VectorXd minus(size);
  const auto moved = [&](Eigen::Index i, double by_i, Eigen::Index j, double by_j) {
    Eigen::VectorXd point = at;
    point(i) += by_i;
    point(j) += by_j;
    return function(point);
  };
  for (Eigen::Index i = 0; i < size; ++i) {
    plus(i) = moved(i, kStep, i, 0.0);
    minus(i) = moved(i, -kStep, i, 0.0);
    gradient(i) = (plus(i) - minus(i)) / (2.0 * kStep);
    hessian(i, i) = (plus(i) - 2.0 * centre + minus(i)) / (kStep * kStep);
    for (Eigen::Index j = 0; j < i; ++j) {
      const double both = moved(i, kStep, j, kStep) + moved(i, -kStep, j, -kStep);
      hessian(i, j) = (both - plus(i) - minus(i) - plus(j) - minus(j) + 2.0 * centre) / (2.0 * kStep * kStep);
      hessian(j, i) = hessian(i, j);
    }
  }
}

// Newton's method with Levenberg damping inside the box |theta| <= kMaxTransformed.
Eigen::VectorXd minimise(const RestrictedLikelihood& likelihood, Eigen::VectorXd theta) {
  const auto profile = [&](const Eigen::VectorXd& at) { return likelihood.profile(at); };
  double value = profile(theta);
  double damping = 1e-3;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  for (int iteration = 0; iteration < 60; ++iteration) {
    differentiate(profile, theta, gradient, hessian);
    const double scale = std::max(hessian.diagonal().cwiseAbs().maxCoeff(), 1.0);
    double gain = 0.0;
    while (damping < 1e6) {
      Eigen::MatrixXd damped = hessian;
      damped.diagonal().array() += damping * scale;
      const Eigen::LLT<Eigen::MatrixXd> factor(damped);
      if (factor.info() == Eigen::Success) {
        const Eigen::VectorXd candidate =
            (theta - factor.solve(gradient)).cwiseMax(-kMaxTransformed).cwiseMin(kMaxTransformed);
        const double candidate_value = profile(candidate);
        if (candidate_value < value) {
          gain = value - candidate_value;
          theta = candidate;
          value = candidate_value;
          damping = std::max(damping / 10.0, 1e-9);
          break;
        }
      }
      damping *= 10.0;
    }
    // A thousandth of the likelihood's own statistical scale of one.
    if (gain < 1e-3) break;
  }
  return theta;
}

// Inverse of half the Hessian of -2 log L. A direction in which the likelihood is flat is one in which the
// noise is not known: it gets a variance of 1e4, which no test survives, instead of a negative one.
Eigen::MatrixXd curvature_covariance(const RestrictedLikelihood& likelihood, const Eigen::VectorXd& at) {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  differentiate([&](const Eigen::VectorXd& p) { return likelihood.full(p); }, at, gradient, hessian);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * hessian);
  const Eigen::VectorXd inverse = solver.eigenvalues().cwiseMax(1e-4).cwiseInverse();
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

Eigen::VectorXd AutoregressiveNoise::coefficients() const {
  return durbin_levinson(partial).coefficients.back();
}

double AutoregressiveNoise::lag1_correlation() const {
  return partial.size() > 0 ? partial(0) : 0.0;
}

double AutoregressiveNoise::effective_samples(Eigen::Index rows) const {
  const Predictors predictors = durbin_levinson(partial);
  const double gain = 1.0 - predictors.coefficients.back().sum();
  return static_cast<double>(rows) * predictors.variance.front() * gain * gain;
}

Eigen::MatrixXd whiten(const Eigen::MatrixXd& rows, const std::vector<RowRange>& segments,
                       const Eigen::VectorXd& partial) {
  const Predictors predictors = durbin_levinson(partial);
  const Eigen::Index order = partial.size();
  Eigen::MatrixXd out(total_rows(segments), rows.cols());
  Eigen::Index next = 0;
  for (const RowRange& segment : segments) {
    for (Eigen::Index t = 0; t < segment.count; ++t, ++next) {
      const auto used = static_cast<std::size_t>(std::min(t, order));
      const Eigen::VectorXd& a = predictors.coefficients[used];
      out.row(next) = rows.row(segment.begin + t);
      for (Eigen::Index lag = 1; lag <= a.size(); ++lag) {
        out.row(next) -= a(lag - 1) * rows.row(segment.begin + t - lag);
      }
      out.row(next) /= std::sqrt(predictors.variance[used]);
    }
  }
  return out;
}

LaggedProducts::LaggedProducts(const Eigen::MatrixXd& z, std::vector<RowRange> segments,
                               Eigen::Index max_order)
    : segments_(std::move(segments)), max_order_(max_order), rows_(total_rows(segments_)) {
  Eigen::Index head_rows = 0;
  for (const RowRange& segment : segments_) {
    head_segments_.push_back({head_rows, std::min(segment.count, max_order_)});
    head_rows += head_segments_.back().count;
  }
  heads_.resize(head_rows, z.cols());
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    heads_.middleRows(head_segments_[s].begin, head_segments_[s].count) =
        z.middleRows(segments_[s].begin, head_segments_[s].count);
  }
  for (Eigen::Index i = 0; i <= max_order_; ++i) {
    for (Eigen::Index j = i; j <= max_order_; ++j) {
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(z.cols(), z.cols());
      for (const RowRange& segment : segments_) {
        const Eigen::Index count = segment.count - max_order_;
        if (count <= 0) continue;
        const Eigen::Index first = segment.begin + max_order_;
        sum.noalias() += z.middleRows(first - i, count).transpose() * z.middleRows(first - j, count);
      }
      products_.push_back(std::move(sum));
    }
  }
}

Eigen::MatrixXd LaggedProducts::gram(const Eigen::VectorXd& partial) const {
  if (partial.size() > max_order_) throw std::invalid_argument("noise order above the products' largest lag");
  const Eigen::VectorXd a = durbin_levinson(partial).coefficients.back();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(max_order_ + 1);
  weights(0) = 1.0;
  weights.segment(1, a.size()) = -a;
  const Eigen::MatrixXd heads = whiten(heads_, head_segments_, partial);
  Eigen::MatrixXd sum = heads.transpose() * heads;
  std::size_t next = 0;
  for (Eigen::Index i = 0; i <= max_order_; ++i) {
    for (Eigen::Index j = i; j <= max_order_; ++j, ++next) {
      const double weight = weights(i) * weights(j);
      if (weight == 0.0) continue;
      sum += weight * products_[next];
      if (i != j) sum += weight * products_[next].transpose();
    }
  }
  return sum;
}

double LaggedProducts::log_determinant(const Eigen::VectorXd& partial) const {
  const Predictors predictors = durbin_levinson(partial);
  double sum = 0.0;
  for (const RowRange& segment : segments_) {
    const auto heads = static_cast<std::size_t>(std::min(segment.count, partial.size()));
    for (std::size_t t = 0; t < heads; ++t) sum += std::log(predictors.variance[t]);
  }
  return sum;
}

AutoregressiveNoise fit_noise(const LaggedProducts& products, bool white) {
  const RestrictedLikelihood likelihood(products);
  AutoregressiveNoise noise;
  double best = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best_theta;
  Eigen::VectorXd theta(0);
  for (Eigen::Index order = 0; order <= (white ? 0 : products.max_order()); ++order) {
    if (order > 0) {
      theta.conservativeResize(order);
      theta(order - 1) = 0.0;
      theta = minimise(likelihood, theta);
    }
    const double aic = likelihood.profile(theta) + 2.0 * static_cast<double>(order + 1);
    noise.aic_per_order.push_back(aic);
    if (aic < best) {
      best = aic;
      best_theta = theta;
    }
  }
  const RestrictedLikelihood::Parts parts = likelihood.parts(best_theta);
  noise.partial = best_theta.array().tanh();
  noise.innovation_variance = parts.residual_square / parts.dof;
  Eigen::VectorXd parameters(best_theta.size() + 1);
  parameters << best_theta, std::log(noise.innovation_variance);
  noise.covariance = curvature_covariance(likelihood, parameters);
  return noise;
}

}  // namespace hemi::calibration

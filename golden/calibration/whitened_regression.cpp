// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/whitened_regression.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

#include "golden/calibration/linear_fit.hpp"

namespace hemi::calibration {
namespace {

// Orders up to eight follow noise with two or three time constants; one parameter for thirty rows at most.
Eigen::Index largest_order(Eigen::Index rows) {
  return std::clamp<Eigen::Index>(rows / 30, 1, 8);
}

// The linearised variance of a variance has no bound where the noise's correlation time is hardly known, yet
// the variance itself has one: generalised least squares turns into differences as the correlation goes to
// one.
constexpr double kLeastDof = 2.0;

Eigen::MatrixXd upper_triangle(const Eigen::HouseholderQR<Eigen::MatrixXd>& qr, Eigen::Index size) {
  return qr.matrixQR().topRows(size).triangularView<Eigen::Upper>();
}

}  // namespace

WhitenedRegression::WhitenedRegression(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                       const std::vector<RowRange>& segments, bool assume_white_noise)
    : rows_(total_rows(segments)) {
  const Eigen::Index columns = x.cols();
  // Ordinary least squares first: its residual carries the noise, without the drift's digits in front of it.
  const LinearFit ordinary = fit_linear(x, y);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(x);
  basis_change_ = upper_triangle(qr, columns);
  Eigen::MatrixXd z(x.rows(), columns + 1);
  z.leftCols(columns) = qr.householderQ() * Eigen::MatrixXd::Identity(x.rows(), columns);
  z.col(columns) = ordinary.residuals;
  const LaggedProducts products(z, segments, assume_white_noise ? 0 : largest_order(rows_));
  noise_ = fit_noise(products, assume_white_noise);

  Eigen::MatrixXd joined(x.rows(), columns + 1);
  joined << x, y;
  const Eigen::MatrixXd whitened = whiten(joined, segments, noise_.partial);
  const Eigen::HouseholderQR<Eigen::MatrixXd> whitened_qr(whitened);
  const Eigen::MatrixXd whole = upper_triangle(whitened_qr, columns + 1);
  triangle_ = whole.topLeftCorner(columns, columns);
  projection_ = whole.col(columns).head(columns);

  const Eigen::VectorXd theta = noise_.partial.array().atanh();
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    // A quarter of the parameter's own uncertainty: the slope that matters is the one over that range.
    const double step = std::min(0.25 * std::sqrt(noise_.covariance(i, i)), 0.1);
    moved_by_.push_back(step);
    Eigen::VectorXd moved = theta;
    moved(i) = theta(i) + step;
    information_plus_.push_back(information(moved, products));
    moved(i) = theta(i) - step;
    information_minus_.push_back(information(moved, products));
  }
}

Eigen::MatrixXd WhitenedRegression::information(const Eigen::VectorXd& theta,
                                                const LaggedProducts& products) const {
  const Eigen::Index columns = basis_change_.cols();
  const Eigen::MatrixXd gram = products.gram(theta.array().tanh().matrix()).topLeftCorner(columns, columns);
  return basis_change_.transpose() * gram * basis_change_;
}

double WhitenedRegression::variance_factor(const Eigen::MatrixXd& information,
                                           const std::vector<Eigen::Index>& subset, std::size_t which) const {
  const auto size = static_cast<Eigen::Index>(subset.size());
  const Eigen::MatrixXd part = information(subset, subset);
  return part.llt().solve(Eigen::VectorXd::Unit(size, static_cast<Eigen::Index>(which)))(
      static_cast<Eigen::Index>(which));
}

double WhitenedRegression::sum_of_squares(const std::vector<Eigen::Index>& subset) const {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(triangle_(Eigen::all, subset));
  const Eigen::VectorXd rotated = qr.householderQ().adjoint() * projection_;
  return rotated.tail(rotated.size() - static_cast<Eigen::Index>(subset.size())).squaredNorm();
}

PartialTest WhitenedRegression::test(const std::vector<Eigen::Index>& subset, std::size_t which) const {
  const auto size = static_cast<Eigen::Index>(subset.size());
  const auto target = static_cast<Eigen::Index>(which);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(triangle_(Eigen::all, subset));
  const Eigen::MatrixXd r = upper_triangle(qr, size);
  const Eigen::VectorXd coefficients = qr.solve(projection_);
  const Eigen::VectorXd row =
      r.transpose().triangularView<Eigen::Lower>().solve(Eigen::VectorXd::Unit(size, target));
  const double variance = noise_.innovation_variance * row.squaredNorm();

  // Delta method on log(variance): its derivative with respect to the log innovation variance is one.
  Eigen::VectorXd gradient(noise_.covariance.rows());
  gradient(gradient.size() - 1) = 1.0;
  for (std::size_t i = 0; i < moved_by_.size(); ++i) {
    gradient(static_cast<Eigen::Index>(i)) =
        (std::log(variance_factor(information_plus_[i], subset, which)) -
         std::log(variance_factor(information_minus_[i], subset, which))) /
        (2.0 * moved_by_[i]);
  }
  PartialTest result{};
  result.coefficient = coefficients(target);
  result.standard_error = std::sqrt(variance);
  result.f_statistic = coefficients(target) * coefficients(target) / variance;
  result.dof = std::clamp(2.0 / gradient.dot(noise_.covariance * gradient), kLeastDof,
                          static_cast<double>(rows_ - triangle_.cols()));
  const boost::math::fisher_f_distribution<double> distribution(1.0, result.dof);
  result.p_value = boost::math::cdf(boost::math::complement(distribution, result.f_statistic));
  return result;
}

}  // namespace hemi::calibration

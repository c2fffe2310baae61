// SPDX-License-Identifier: Apache-2.0
#include "golden/rivals/regression.hpp"

#include <Eigen/QR>
#include <boost/math/distributions/complement.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

namespace hemi::rivals {

Regression regress(const Eigen::MatrixXd& columns, const Eigen::VectorXd& values) {
  Eigen::VectorXd scale = columns.colwise().norm();
  for (double& one : scale) one = one > 0.0 ? one : 1.0;
  const Eigen::MatrixXd scaled = columns * scale.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  qr.setThreshold(1e-9);
  Regression fit;
  fit.coefficients = qr.solve(values);
  fit.squares = (values - scaled * fit.coefficients).squaredNorm();
  fit.coefficients = fit.coefficients.cwiseQuotient(scale);
  fit.rank = qr.rank();
  return fit;
}

double bic(const Regression& fit, Eigen::Index samples) {
  const double n = static_cast<double>(samples);
  return n * std::log(std::max(fit.squares, 1e-300) / n) + static_cast<double>(fit.rank) * std::log(n);
}

double f_test(const Regression& part, const Regression& full, Eigen::Index samples) {
  const double more = static_cast<double>(full.rank - part.rank);
  const double rest = static_cast<double>(samples - full.rank);
  if (more <= 0.0 || rest <= 0.0) return 1.0;
  const double f = (part.squares - full.squares) / more / (full.squares / rest);
  if (!(f > 0.0)) return 1.0;
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(more, rest), f));
}

}  // namespace hemi::rivals

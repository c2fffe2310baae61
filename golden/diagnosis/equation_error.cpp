// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/equation_error.hpp"

#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

#include "golden/calibration/linear_fit.hpp"

namespace hemi::diagnosis {
namespace {

constexpr double kTaper = 0.1;  // of the record, at either end
constexpr double two_pi = boost::math::constants::two_pi<double>();

// Longest even length of small factors, for which the transform is fast.
Eigen::Index fast_length(Eigen::Index rows) {
  for (Eigen::Index n = rows - rows % 2;; n -= 2) {
    Eigen::Index rest = n;
    for (const Eigen::Index factor : {2, 3, 5}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return n;
  }
}

Eigen::VectorXd tapered(const Eigen::VectorXd& x) {
  const auto n = static_cast<double>(x.size());
  Eigen::VectorXd result = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double edge =
        std::min(static_cast<double>(i) + 0.5, n - static_cast<double>(i) - 0.5) / (kTaper * n);
    if (edge < 1.0) result[i] *= 0.5 - 0.5 * std::cos(0.5 * two_pi * edge);
  }
  return result;
}

// The derivative of the given order of the tapered signal.
Eigen::VectorXd derivative(const Eigen::VectorXd& x, int order, double sample_rate_hz) {
  Eigen::FFT<double> fft;
  Eigen::VectorXcd spectrum;
  fft.fwd(spectrum, x);
  const Eigen::Index n = x.size();
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto turns = static_cast<double>(k <= n / 2 ? k : k - n);
    const std::complex<double> jw(0.0, two_pi * turns * sample_rate_hz / static_cast<double>(n));
    spectrum[k] *= 2 * k == n && order == 1 ? std::complex<double>(0.0) : std::pow(jw, order);
  }
  Eigen::VectorXd result;
  fft.inv(result, spectrum);
  return result;
}

}  // namespace

Eigen::Vector4d equation_error_start(const Eigen::VectorXd& force_v, const Eigen::VectorXd& displacement_v,
                                     double sample_rate_hz) {
  if (force_v.size() < 64) throw std::invalid_argument("fewer than 64 rows");
  const Eigen::Index n = fast_length(force_v.size());
  const double mean_y = displacement_v.head(n).mean();
  const Eigen::VectorXd y = tapered(displacement_v.head(n).array() - mean_y);
  const Eigen::VectorXd velocity = derivative(y, 1, sample_rate_hz);
  const Eigen::VectorXd acceleration = derivative(y, 2, sample_rate_hz);
  const auto edge = static_cast<Eigen::Index>(std::ceil(kTaper * static_cast<double>(n))) + 1;
  const Eigen::Index rows = n - 2 * edge;
  Eigen::MatrixXd design(rows, 4);
  design << force_v.segment(edge, rows), -velocity.segment(edge, rows), -displacement_v.segment(edge, rows),
      Eigen::VectorXd::Ones(rows);
  return calibration::fit_linear(design, acceleration.segment(edge, rows),
                                 {"force_v", "velocity", "displacement_v", "constant"})
      .coefficients;
}

}  // namespace hemi::diagnosis

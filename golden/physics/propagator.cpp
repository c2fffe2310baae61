// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/propagator.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace hemi::physics {

namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;

// u'' + G u' + K u = f, u = (x, y)
struct Oscillator {
  Matrix2d damping;
  Matrix2d stiffness;
};

Oscillator oscillator(const Parameters& p) {
  const double coriolis = 2.0 * p.kappa * p.rate_rad_s;
  const double euler = p.kappa * p.rate_slope_rad_s2;
  const double w = p.omega_rad_s;
  const double stiffness = w * w - p.centrifugal * p.rate_rad_s * p.rate_rad_s;
  Oscillator o;
  o.damping << 2.0 * p.damping_per_s + p.mismatch_cos_per_s, p.mismatch_sin_per_s - coriolis,
      p.mismatch_sin_per_s + coriolis, 2.0 * p.damping_per_s - p.mismatch_cos_per_s;
  o.stiffness << stiffness - w * p.split_cos_rad_s, -w * p.split_sin_rad_s - euler,
      -w * p.split_sin_rad_s + euler, stiffness + w * p.split_cos_rad_s;
  return o;
}

// exp(a) - 1 for a norm below 0.3: the first term left out is 0.3^14 / 14! = 5e-19.
Matrix4d small_exponential_change(const Matrix4d& a) {
  constexpr auto inverse_factorial = [] {
    std::array<double, 14> values{1.0};
    for (int i = 1; i < 14; ++i) values[i] = values[i - 1] / i;
    return values;
  }();
  const Matrix4d a2 = a * a;
  const Matrix4d a3 = a2 * a;
  const Matrix4d a4 = a2 * a2;
  // sum of a^(i - 1) / i! for i = first .. first + 3
  const auto block = [&](int first) {
    Matrix4d sum = inverse_factorial[first + 1] * a + inverse_factorial[first + 2] * a2 +
                   inverse_factorial[first + 3] * a3;
    sum.diagonal().array() += inverse_factorial[first];
    return sum;
  };
  Matrix4d sum = block(9) + inverse_factorial[13] * a4;
  sum = block(5) + a4 * sum;
  sum = block(1) + a4 * sum;
  return a * sum;
}

}  // namespace

Propagator make_propagator(const Parameters& p, double step_s, double scale) {
  const Oscillator o = oscillator(p);
  int halvings = 0;
  double h = step_s;
  while (h * p.omega_rad_s > 0.3) {
    h /= 2.0;
    ++halvings;
  }
  // in the order (x, y, x'/s, y'/s), which has the blocks of the equations
  Matrix4d a = Matrix4d::Zero();
  a.topRightCorner<2, 2>().diagonal().setConstant(scale * h);
  a.bottomLeftCorner<2, 2>() = o.stiffness * (-h / scale);
  a.bottomRightCorner<2, 2>() = o.damping * -h;
  Matrix4d change = small_exponential_change(a);
  for (int i = 0; i < halvings; ++i) change = 2.0 * change + change * change;

  // A force f held over h is a shift of the rest position to f / K: z = (Phi - 1) (-f / K, 0).
  const Eigen::Matrix<double, 4, 2> response = -change.leftCols<2>() * o.stiffness.inverse();

  const std::array<int, 4> order{0, 2, 1, 3};
  return {change(order, order), response(order, Eigen::all)};
}

}  // namespace hemi::physics

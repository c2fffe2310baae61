// SPDX-License-Identifier: Apache-2.0
#include "tests/golden/physics/reference_integrator.hpp"

#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <cmath>
#include <numbers>

namespace hemi::physics::testing {

namespace {

using Real = long double;
using State = std::array<Real, 4>;  // x, x'/w, y, y'/w over the angle w t

}  // namespace

Motion integrate(const Parameters& p, const Motion& start, const Inputs& in, double duration_s,
                 double tolerance) {
  // over the angle w t: rates by w, accelerations by w^2
  const Real w = p.omega_rad_s;
  const Real coriolis = 2 * p.kappa * p.rate_rad_s / w;
  const Real euler = p.kappa * p.rate_slope_rad_s2 / (w * w);
  const Real damping = 2 * p.damping_per_s / w;
  const Real quadratic_damping = damping * 3 * std::numbers::pi_v<Real> / 8 * p.quadratic_damping;
  const Real cubic_damping = 8 * p.cubic_damping_per_s / (3 * w);
  const bool nonlinear_damping = quadratic_damping != 0 || cubic_damping != 0;
  const Real mismatch_cos = p.mismatch_cos_per_s / w;
  const Real mismatch_sin = p.mismatch_sin_per_s / w;
  const Real split_cos = p.split_cos_rad_s / w;
  const Real split_sin = (p.split_sin_rad_s + static_cast<Real>(p.quadrature_span_rad_s) * in.quadrature) / w;
  const Real stiffness = 1 - p.centrifugal * static_cast<Real>(p.rate_rad_s) * p.rate_rad_s / (w * w);
  const Real cubic = p.cubic_stiffness;
  const Real quadratic = p.quadratic_stiffness;
  const Real fx = in.fx / (w * w);
  const Real fy = in.fy / (w * w);
  const auto equations = [&](const State& z, State& dz, Real) {
    const auto [x, vx, y, vy] = z;
    Real loss = damping;
    if (nonlinear_damping) {
      const Real speed = std::sqrt(vx * vx + vy * vy);
      loss += speed * (quadratic_damping + cubic_damping * speed);
    }
    const Real spring = stiffness + cubic * (x * x + y * y);
    dz = {vx,
          fx + coriolis * vy + euler * y - loss * vx - (mismatch_cos * vx + mismatch_sin * vy) - spring * x +
              (split_cos * x + split_sin * y) - quadratic * x * x,
          vy,
          fy - coriolis * vx - euler * x - loss * vy - (mismatch_sin * vx - mismatch_cos * vy) - spring * y +
              (split_sin * x - split_cos * y) - quadratic * y * y};
  };
  namespace odeint = boost::numeric::odeint;
  State z{start.x, start.x_rate_per_s / w, start.y, start.y_rate_per_s / w};
  const Real each = tolerance;
  odeint::integrate_adaptive(odeint::bulirsch_stoer<State, Real>(each, each), equations, z, Real{0},
                             w * static_cast<Real>(duration_s), Real{0.5});
  return {static_cast<double>(z[0]), static_cast<double>(z[1] * w), static_cast<double>(z[2]),
          static_cast<double>(z[3] * w)};
}

}  // namespace hemi::physics::testing

// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "golden/physics/instrument.hpp"
#include "tests/golden/physics/reference_integrator.hpp"

namespace hemi::physics {
namespace {

using testing::Inputs;
using testing::integrate;

constexpr double kStep_s = 1e-5;

// Every linear term large enough to be seen.
Parameters busy_parameters() {
  Parameters p = Instrument{}.at(20.0);
  p.rate_rad_s = 1.7;
  p.rate_slope_rad_s2 = 20.0;
  p.mismatch_cos_per_s = 2e-3;
  p.mismatch_sin_per_s = -1e-3;
  p.split_cos_rad_s = 3.0;
  p.split_sin_rad_s = -5.0;
  p.centrifugal = 30.0;
  return p;
}

double distance(const Motion& a, const Motion& b, double omega_rad_s) {
  return std::hypot(
      std::hypot(a.x - b.x, a.y - b.y),
      std::hypot(a.x_rate_per_s - b.x_rate_per_s, a.y_rate_per_s - b.y_rate_per_s) / omega_rad_s);
}

Motion propagate(const Parameters& p, const Motion& start, const Inputs& in, double step_s, int steps) {
  Resonator resonator(p, step_s, p.omega_rad_s * 1.01);
  resonator.set_motion(start);
  for (int i = 0; i < steps; ++i) resonator.step(in.fx, in.fy, in.quadrature);
  return resonator.motion();
}

const Motion kStart{0.8, 5000.0, -0.3, 9000.0};

// Rounding: each entry of the propagator errs by less than 1e-16, so that 2.3e6 steps turn the phase by less
// than 2.3e-10; the rounding of the state is random and adds 1e-16 sqrt(2.3e6). The reference takes about
// four steps a period, each with an error below 1e-15.
TEST(Propagator, AgreesWithAnAdaptiveIntegratorOverAHundredThousandPeriods) {
  const Parameters p = busy_parameters();
  const int steps = static_cast<int>(std::lround(1e5 * 2.0 * std::numbers::pi / p.omega_rad_s / kStep_s));
  const Motion ours = propagate(p, kStart, {}, kStep_s, steps);
  const Motion reference = integrate(p, kStart, {}, steps * kStep_s, 1e-15);
  const double relative = distance(ours, reference, p.omega_rad_s) / distance(reference, {}, p.omega_rad_s);
  RecordProperty("relative_difference", fmt::format("{:.2e}", relative));
  EXPECT_LT(relative, 1e-9);
}

// Each sample its own forces. 400 samples amplify the rounding of a state near 1 to no more than a few 1e-14.
TEST(Propagator, HoldsForcesOverASample) {
  const Parameters p = busy_parameters();
  Resonator resonator(p, kStep_s, p.omega_rad_s);
  resonator.set_motion(kStart);
  Motion reference = kStart;
  for (int n = 0; n < 400; ++n) {
    const Inputs in{3e7 * std::sin(0.7 * n), 2e7 * std::cos(0.31 * n * n), 0.0};
    resonator.step(in.fx, in.fy, in.quadrature);
    reference = integrate(p, reference, in, kStep_s, 1e-17);
  }
  EXPECT_LT(distance(resonator.motion(), reference, p.omega_rad_s), 1e-12);
  EXPECT_GT(std::hypot(reference.x, reference.y), 0.1);
}

// A step of several radians is halved first.
TEST(Propagator, TakesStepsOfAnyLength) {
  const Parameters p = busy_parameters();
  for (const double step_s : {1e-6, 2.2675736961451248e-5, 1e-4, 3e-3}) {
    const Inputs in{1e6, -2e6, 0.0};
    EXPECT_LT(distance(propagate(p, kStart, in, step_s, 3), integrate(p, kStart, in, 3 * step_s, 1e-17),
                       p.omega_rad_s),
              1e-12)
        << step_s;
  }
}

// Error over 2 ms at steps of h, h/2 and h/4: each halving must divide it by 4, up to terms of order h^4, (w
// h)^2 = 0.08 of themselves and less.
void expect_second_order(const Parameters& p, const Inputs& in) {
  const Motion reference = integrate(p, kStart, in, 2e-3, 1e-17);
  double last = 0.0;
  for (const int division : {1, 2, 4}) {
    const double error =
        distance(propagate(p, kStart, in, kStep_s / division, 200 * division), reference, p.omega_rad_s);
    if (division > 1) {
      EXPECT_NEAR(std::log2(last / error), 2.0, 0.08) << "error " << error;
    }
    last = error;
  }
  EXPECT_GT(last, 1e-12);  // otherwise rounding was measured
}

TEST(Splitting, IsOfSecondOrderInTheQuadratureCommand) {
  Parameters p = busy_parameters();
  p.quadrature_span_rad_s = 300.0;
  expect_second_order(p, {0.0, 0.0, 0.7});
}

TEST(Splitting, IsOfSecondOrderInTheSprings) {
  Parameters p = busy_parameters();
  p.cubic_stiffness = 1e-3;
  expect_second_order(p, {});
  p.cubic_stiffness = 0.0;
  p.quadratic_stiffness = 1e-3;
  expect_second_order(p, {});
}

TEST(Splitting, IsOfSecondOrderInTheDamping) {
  Parameters p = busy_parameters();
  p.damping_per_s = 10.0;
  p.quadratic_damping = 2.0;
  expect_second_order(p, {});
  p.quadratic_damping = 0.0;
  p.cubic_damping_per_s = 20.0;
  expect_second_order(p, {});
}

TEST(Splitting, IsOfSecondOrderInAllTogether) {
  Parameters p = busy_parameters();
  p.damping_per_s = 10.0;
  p.quadratic_damping = 2.0;
  p.cubic_damping_per_s = 20.0;
  p.cubic_stiffness = 1e-3;
  p.quadratic_stiffness = 2e-3;
  p.quadrature_span_rad_s = 100.0;
  expect_second_order(p, {2e4, -1e4, 0.7});
}

// The nominal electrode at full scale against the same stiffness in the exact propagator, over one second. To
// first order in dw/w the kicks couple the modes as the continuous stiffness does; the positions' ripple is
// (dw/w)(w h)^2/12, and what grows with time is of second order: (dw/w)^2 (w h)^2 w t.
TEST(Splitting, OfTheNominalElectrodeIsNegligible) {
  Parameters p = Instrument{}.at(20.0);
  const Motion kicked = propagate(p, kStart, {0.0, 0.0, 1.0}, kStep_s, 100000);
  p.split_sin_rad_s += p.quadrature_span_rad_s;
  const Motion exact = propagate(p, kStart, {}, kStep_s, 100000);
  const double relative_split = p.quadrature_span_rad_s / p.omega_rad_s;
  const double angle = p.omega_rad_s * kStep_s;
  EXPECT_LT(distance(kicked, exact, p.omega_rad_s),
            angle * angle * relative_split * (1.0 / 12.0 + relative_split * p.omega_rad_s));
}

}  // namespace
}  // namespace hemi::physics

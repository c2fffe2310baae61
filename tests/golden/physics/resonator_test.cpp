// SPDX-License-Identifier: Apache-2.0
// The resonator against closed forms of the averaged equations.
//
// A coupling of e [rad/s] changes an amplitude by e t, and by a ripple of up to e/(2w) at either end, from
// the part of it that turns at twice the frequency: what is measured over t carries a relative error of up to
// 1/(w t), here 3.6e-5 over 1 s. Twice that is allowed.
#include "golden/physics/resonator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "golden/physics/instrument.hpp"

namespace hemi::physics {
namespace {

using Complex = std::complex<double>;

constexpr double kStep_s = 1e-5;
constexpr double kPi = std::numbers::pi;
constexpr double kDphPerRad_s = 1.0 / kRadPerSecondPerDph;

// Nothing but the springs.
Parameters bare() {
  Parameters p;
  p.omega_rad_s = Instrument{}.at(20.0).omega_rad_s;
  p.kappa = 0.554;
  return p;
}

double ripple(const Parameters& p, double duration_s) {
  return 2.0 / (p.omega_rad_s * duration_s);
}

// Complex amplitudes in the frame that turns at w: x = Re(X e^{jwt}).
struct Amplitudes {
  Complex x;
  Complex y;
};

Amplitudes run(const Parameters& p, const Motion& start, double duration_s, double step_s = kStep_s) {
  Resonator resonator(p, step_s, p.omega_rad_s);
  resonator.set_motion(start);
  const auto steps = std::lround(duration_s / step_s);
  for (long i = 0; i < steps; ++i) resonator.step(0.0, 0.0, 0.0);
  const Motion m = resonator.motion();
  const Complex frame =
      std::polar(1.0, -std::fmod(p.omega_rad_s * step_s * static_cast<double>(steps), 2.0 * kPi));
  return {Complex(m.x, -m.x_rate_per_s / p.omega_rad_s) * frame,
          Complex(m.y, -m.y_rate_per_s / p.omega_rad_s) * frame};
}

const Motion kPrimary{1.0, 0.0, 0.0, 0.0};

TEST(Resonator, PatternPrecessesByBryansFactor) {
  Parameters p = bare();
  p.rate_rad_s = 100.0 * kPi / 180.0;
  const auto [x, y] = run(p, kPrimary, 1.0);
  // an angle on the shell is half of that between the modes' coordinates
  const double angle_rad =
      0.5 * 0.5 * std::atan2(2.0 * std::real(x * std::conj(y)), std::norm(x) - std::norm(y));
  EXPECT_NEAR(angle_rad / (-0.277 * p.rate_rad_s), 1.0, ripple(p, 1.0));
}

TEST(Resonator, RingsDownWithItsTimeConstant) {
  Parameters p = bare();
  p.damping_per_s = 1.0 / 719.0;
  EXPECT_NEAR(-std::log(std::abs(run(p, kPrimary, 1.0).x)) * 719.0, 1.0, ripple(p, 1.0));
}

TEST(Resonator, DampingMismatchSeparatesTheAxes) {
  Parameters p = bare();
  p.damping_per_s = 0.02;
  p.mismatch_cos_per_s = 0.01;
  EXPECT_NEAR(-std::log(std::abs(run(p, kPrimary, 1.0).x)) / 0.025, 1.0, ripple(p, 1.0));
  EXPECT_NEAR(-std::log(std::abs(run(p, {0.0, 0.0, 1.0, 0.0}, 1.0).y)) / 0.015, 1.0, ripple(p, 1.0));
}

// Axes at 45 degrees of the modes: |X| = |cos(dw t / 2)|, the first beat's null after 1/(2 split). Near the
// null X goes through zero linearly, and the time follows from the residue.
TEST(Resonator, BeatsWithTheFrequencySplit) {
  Parameters p = bare();
  const double split_hz = 0.5;
  p.split_sin_rad_s = 2.0 * kPi * split_hz;
  const double t_s = 0.98;
  const auto [x, y] = run(p, kPrimary, t_s);
  const double measured_hz = (kPi / 2.0 - std::asin(std::abs(x))) / (kPi * t_s);
  EXPECT_NEAR(measured_hz / split_hz, 1.0, ripple(p, t_s));
  EXPECT_NEAR(std::norm(x) + std::norm(y), 1.0, p.split_sin_rad_s / p.omega_rad_s);
}

TEST(Resonator, SplitSeparatesTheFrequencies) {
  Parameters p = bare();
  p.split_cos_rad_s = 2.0 * kPi * 0.1;
  EXPECT_NEAR(std::arg(run(p, kPrimary, 1.0).x) / (-p.split_cos_rad_s / 2.0), 1.0, ripple(p, 1.0));
  EXPECT_NEAR(std::arg(run(p, {0.0, 0.0, 1.0, 0.0}, 1.0).y) / (p.split_cos_rad_s / 2.0), 1.0, ripple(p, 1.0));
}

// The secondary's growth over what a rate W would give, -kappa W X
double apparent_rate_rad_s(const Parameters& p, const Complex& y, double duration_s) {
  return -y.real() / (p.kappa * duration_s);
}

TEST(Resonator, ZeroRateBiasOfDampingMismatch) {
  Parameters p = bare();
  const double mismatch_per_s = 0.01 / 719.0;
  const double axis_rad = 20.0 * kPi / 180.0;
  p.mismatch_cos_per_s = mismatch_per_s * std::cos(2.0 * axis_rad);
  p.mismatch_sin_per_s = mismatch_per_s * std::sin(2.0 * axis_rad);
  const Complex y = run(p, kPrimary, 1.0).y;
  const double expected = mismatch_per_s * std::sin(2.0 * axis_rad) / (2.0 * 0.554);
  EXPECT_NEAR(apparent_rate_rad_s(p, y, 1.0) / expected, 1.0, ripple(p, 1.0));
  // as printed: 0.90 d sin 2th_tau, 2.6 deg/h for 1 %
  EXPECT_NEAR(apparent_rate_rad_s(p, y, 1.0) / (mismatch_per_s * std::sin(2.0 * axis_rad)), 0.90, 0.005);
  EXPECT_NEAR(expected / std::sin(2.0 * axis_rad) * kDphPerRad_s, 2.6, 0.05);
}

// Damping and stiffness couple both ways alike, a rate with opposite signs.
TEST(Resonator, CouplesTheSecondaryBack) {
  const Motion secondary{0.0, 0.0, 1.0, 0.0};
  Parameters mismatch = bare();
  mismatch.mismatch_sin_per_s = 1e-3;
  EXPECT_NEAR(run(mismatch, secondary, 1.0).x.real() / -0.5e-3, 1.0, ripple(mismatch, 1.0));
  Parameters split = bare();
  split.split_sin_rad_s = 1e-3;
  EXPECT_NEAR(run(split, secondary, 1.0).x.imag() / -0.5e-3, 1.0, ripple(split, 1.0));
  Parameters turning = bare();
  turning.rate_rad_s = 1e-3;
  EXPECT_NEAR(run(turning, secondary, 1.0).x.real() / (0.554 * 1e-3), 1.0, ripple(turning, 1.0));
  EXPECT_NEAR(run(turning, kPrimary, 1.0).y.real() / (-0.554 * 1e-3), 1.0, ripple(turning, 1.0));
}

TEST(Resonator, QuadratureOfAMillihertz) {
  Parameters p = bare();
  p.split_sin_rad_s = 2.0 * kPi * 1e-3;
  const Complex y = run(p, kPrimary, 1.0).y;
  const double quadrature_dph = -y.imag() / p.kappa * kDphPerRad_s;
  EXPECT_NEAR(quadrature_dph / (p.split_sin_rad_s / (2.0 * p.kappa) * kDphPerRad_s), 1.0, ripple(p, 1.0));
  EXPECT_NEAR(quadrature_dph / 1170.0, 1.0, 1e-3);
}

TEST(Resonator, CentrifugalForceSoftens) {
  Parameters p = bare();
  p.kappa = 0.0;
  p.centrifugal = 0.11;
  p.rate_rad_s = 300.0;
  const double expected = -0.11 * 300.0 * 300.0 / (2.0 * p.omega_rad_s);
  EXPECT_NEAR(std::arg(run(p, kPrimary, 1.0).x) / expected, 1.0, ripple(p, 1.0));
}

// df/f = (3/8) k3 A^2 - (21/256) k3^2 A^4. The start at rest sets A to within k3/8 or so.
TEST(Resonator, DuffingShiftOfALine) {
  Parameters p = bare();
  p.cubic_stiffness = 1e-5;
  for (const double amplitude : {1.0, 0.5}) {
    const double expected = 3.0 / 8.0 * p.cubic_stiffness * amplitude * amplitude * p.omega_rad_s;
    const Amplitudes end = run(p, {amplitude, 0.0, 0.0, 0.0}, 1.0);
    EXPECT_NEAR(std::arg(end.x) / expected, 1.0, ripple(p, 1.0) + p.cubic_stiffness);
  }
}

// On a circle x^2 + y^2 is constant: df/f = k3 A^2 / 2.
TEST(Resonator, DuffingShiftOfACircle) {
  Parameters p = bare();
  p.cubic_stiffness = 1e-5;
  const Amplitudes end = run(p, {1.0, 0.0, 0.0, p.omega_rad_s}, 1.0);
  EXPECT_NEAR(std::arg(end.x) / (0.5 * p.cubic_stiffness * p.omega_rad_s), 1.0,
              ripple(p, 1.0) + p.cubic_stiffness);
}

// df/f = -(5/12) k2^2 A^2, from the mean phases of the first and the last quarter of the run, where rest
// position and harmonics average out. An effect of second order: the splitting sees it with an error of order
// (w h)^2 of itself, and the next term of the series is of order k2^2. A is 1 with the start at x = 1 - k2/3.
TEST(Resonator, QuadraticSpringShiftsFrequency) {
  Parameters p = bare();
  p.quadratic_stiffness = 5e-3;
  const double step_s = 1e-6;
  const int samples = 400000;
  Resonator resonator(p, step_s, p.omega_rad_s);
  resonator.set_motion({1.0 - p.quadratic_stiffness / 3.0, 0.0, 0.0, 0.0});
  Complex first;
  Complex last;
  for (int n = 0; n < samples; ++n) {
    const Motion m = resonator.motion();
    const Complex z =
        Complex(m.x, -m.x_rate_per_s / p.omega_rad_s) * std::polar(1.0, -p.omega_rad_s * step_s * n);
    if (n < samples / 4) first += z;
    if (n >= samples - samples / 4) last += z;
    resonator.step(0.0, 0.0, 0.0);
  }
  const double between_s = 0.75 * samples * step_s;
  const double shift = std::arg(last / first) / (between_s * p.omega_rad_s);
  const double expected = -5.0 / 12.0 * std::pow(p.quadratic_stiffness, 2);
  EXPECT_NEAR(shift / expected, 1.0,
              std::pow(p.omega_rad_s * step_s, 2) + std::pow(p.quadratic_stiffness, 2));
}

// A' = -(1/tau)(1 + c2 A) A
TEST(Resonator, QuadraticDampingFollowsItsAveragedEquation) {
  Parameters p = bare();
  p.damping_per_s = 1.0;
  p.quadratic_damping = 0.5;
  const double expected_ratio = 1.0 / 1.5 * std::exp(-1.0);  // of A / (1 + c2 A)
  const double amplitude = std::abs(run(p, kPrimary, 1.0).x);
  EXPECT_NEAR(amplitude / (1.0 + 0.5 * amplitude) / expected_ratio, 1.0, ripple(p, 1.0) * 1.5);
}

// A' = -(1/tau) A - c3 A^3, solved by 1/A^2 + c3 tau = (1/A0^2 + c3 tau) e^{2t/tau}
TEST(Resonator, CubicDampingFollowsItsAveragedEquation) {
  Parameters p = bare();
  p.damping_per_s = 0.5;
  p.cubic_damping_per_s = 0.4;
  const double expected = (1.0 + 0.8) * std::exp(1.0) - 0.8;
  EXPECT_NEAR(1.0 / std::norm(run(p, kPrimary, 1.0).x) / expected, 1.0, ripple(p, 1.0) * (0.5 + 0.4) * 2.0);
}

TEST(Resonator, AmplitudeIsThatOfThePrimary) {
  const Parameters p = bare();
  Resonator resonator(p, kStep_s, 1.3 * p.omega_rad_s);
  resonator.set_motion({0.3, 0.4 * p.omega_rad_s, 7.0, 7.0});
  EXPECT_NEAR(resonator.amplitude(), 0.5, 1e-15);
}

}  // namespace
}  // namespace hemi::physics

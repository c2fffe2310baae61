// SPDX-License-Identifier: Apache-2.0
// The slow twin's settled telemetry against the full resonator, whose two modes vibrate sample by sample,
// held by four loops that see the complex amplitudes without any electronics between.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "golden/physics/resonator.hpp"
#include "golden/physics/slow_twin.hpp"

namespace hemi::physics {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kStepS = 1e-5;
/// Nine periods: over one block, and with Hann's weights, nothing is left of the ripple at 2 w.
constexpr int kBlock = 203;

/// K (e + z int e), z = K/10, once a block
class Controller {
 public:
  Controller(double bandwidth_hz, double start) : k_(kTwoPi * bandwidth_hz), integral_(start) {}
  double operator()(double error) {
    integral_ += 0.1 * k_ * k_ * error * kBlock * kStepS;
    return integral_ + k_ * error;
  }

 private:
  double k_;
  double integral_;
};

struct Held {
  double frequency_hz = 0.0;
  double drive_growth_per_s = 0.0;
  double quadrature = 0.0;
  double rebalance_growth_per_s = 0.0;
};

/// Averages over the last fifth of four seconds.
Held hold(const Parameters& p, double amplitude) {
  const double w = p.omega_rad_s;
  Resonator resonator(p, kStepS, w);
  resonator.set_motion({amplitude, 0.0, 0.0, 0.0});
  Controller phase_loop(10.0, w);
  Controller amplitude_loop(10.0, amplitude * p.damping_per_s);
  Controller rebalance_loop(20.0, 0.0);
  Controller quadrature_loop(10.0, 0.0);
  const double half_turn = 0.5 * w * kStepS;
  const double held = std::sin(half_turn) / half_turn;  // what holding over a step leaves of a force at w

  double phase = 0.0;
  double reference_rad_s = w;
  double drive = amplitude * p.damping_per_s;
  double rebalance = 0.0;
  double split = 0.0;
  Held mean;
  constexpr int kBlocks = 2000;
  constexpr int kAveraged = 400;
  for (int block = 0; block < kBlocks; ++block) {
    std::complex<double> x = 0.0;
    std::complex<double> y = 0.0;
    for (int n = 0; n < kBlock; ++n) {
      const Motion motion = resonator.motion();
      const double weight = (1.0 - std::cos(kTwoPi * (n + 0.5) / kBlock)) / kBlock;
      const std::complex<double> back = std::polar(weight, -phase);
      x += std::complex<double>(motion.x, -motion.x_rate_per_s / w) * back;
      y += std::complex<double>(motion.y, -motion.y_rate_per_s / w) * back;
      // growth by g takes the force -2 w g sin(phase), here that of the middle of the step
      const double force = -2.0 * w / held * std::sin(phase + 0.5 * reference_rad_s * kStepS);
      resonator.step(force * drive, force * (rebalance + p.forcer_misalignment_rad * drive),
                     split / p.quadrature_span_rad_s);
      phase = std::remainder(phase + reference_rad_s * kStepS, kTwoPi);
    }
    reference_rad_s = phase_loop(std::arg(x));
    drive = amplitude_loop(amplitude - std::abs(x));
    rebalance = rebalance_loop(-y.real());
    split = quadrature_loop(2.0 / amplitude * y.imag());
    if (block >= kBlocks - kAveraged) {
      mean.frequency_hz += reference_rad_s / kTwoPi / kAveraged;
      mean.drive_growth_per_s += drive / kAveraged;
      mean.quadrature += split / p.quadrature_span_rad_s / kAveraged;
      mean.rebalance_growth_per_s += rebalance / kAveraged;
    }
  }
  return mean;
}

struct Case {
  std::string name;
  std::vector<ActiveEffect> effects;
};

class SlowTwinAgainstResonator : public ::testing::TestWithParam<Case> {};

TEST_P(SlowTwinAgainstResonator, SettledValuesAgree) {
  Instrument instrument;
  instrument.damping_mismatch = 0.2;
  instrument.split_hz = 5e-3;
  Environment e;
  e.rate_dph = 500.0;
  e.amplitude_setpoint = 0.9;
  SlowTwinOptions silent;
  silent.noise = false;
  const TelemetrySample twin = simulate_slow(instrument, GetParam().effects, {e}, silent).front();
  World world(instrument, GetParam().effects, e, 0);
  const Parameters& p = world.parameters();
  const Held full = hold(p, 0.9);

  // Settled to exp(-0.6 x 4 s x 63/10) = 3e-7. Terms of second order in split, mismatch and rate over w are
  // of the order of 1e-6 rad/s and below, 2e-7 Hz; the ripple of a block 1e-4 of each command. The
  // resonator's steps see the mean and the second harmonic of a quadratic spring with an error of (2 w
  // h)^2/12, that is 2.6 % of its shift.
  const double wh = p.omega_rad_s * kStepS;
  const double k2_shift_hz = 5.0 / 12.0 * std::pow(p.quadratic_stiffness * 0.9, 2) * twin.frequency_hz;
  EXPECT_NEAR(full.frequency_hz, twin.frequency_hz, 2e-6 + 4.0 * wh * wh / 12.0 * k2_shift_hz);
  EXPECT_NEAR(full.drive_growth_per_s / p.drive_per_s * 10.0, twin.drive_v, 2e-4 * twin.drive_v);
  EXPECT_NEAR(-full.quadrature * 0.9 * 10.0, twin.quadrature_v, 2e-4 * twin.quadrature_v);
  EXPECT_NEAR(full.rebalance_growth_per_s / p.rebalance_per_s * 120.0 * 3600.0, twin.rate_dph, 0.02);
}

INSTANTIATE_TEST_SUITE_P(
    Effects, SlowTwinAgainstResonator,
    ::testing::Values(Case{"nominal", {}}, Case{"duffing", {{"duffing", {{"relative_shift", 1e-6}}}}},
                      Case{"quadratic_stiffness", {{"quadratic_stiffness", {{"k2", 1e6}}}}},
                      Case{"damping_nonlinearity",
                           {{"damping_nonlinearity", {{"relative", 0.3}, {"quadratic", 0.2}}}}},
                      Case{"damping_anisotropy", {{"damping_anisotropy", {{"gain", 2000.0}}}}},
                      Case{"forcer_misalignment", {{"forcer_misalignment", {{"gain", 2000.0}}}}},
                      Case{"frequency_split", {{"frequency_split", {{"span", 2.0}}}}},
                      Case{"gas_leak", {{"gas_leak", {{"initial", 0.5}}}}}),
    [](const auto& parameters) { return parameters.param.name; });

}  // namespace
}  // namespace hemi::physics

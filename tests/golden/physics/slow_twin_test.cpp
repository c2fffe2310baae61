// SPDX-License-Identifier: Apache-2.0
// Settled values and loop transients of the slow twin.
#include "golden/physics/slow_twin.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "golden/physics/slow_twin_loops.hpp"

namespace hemi::physics {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

std::vector<TelemetrySample> silent(const Instrument& instrument, const std::vector<ActiveEffect>& effects,
                                    const std::vector<Environment>& inputs) {
  SlowTwinOptions options;
  options.noise = false;
  return simulate_slow(instrument, effects, inputs, options);
}

TEST(SlowTwin, SettledValuesFollowTheClosedForms) {
  Environment e;
  e.rate_dph = 1000.0;
  e.chamber_degc = 30.0;
  const TelemetrySample s = silent(Instrument{}, {}, {e}).front();
  const double f = 4424.90095 + 30.0 * (0.371555556 + 30.0 * (-9.70238095e-4 + 30.0 * 1.52777778e-5));
  const double f20 = 4424.90095 + 20.0 * (0.371555556 + 20.0 * (-9.70238095e-4 + 20.0 * 1.52777778e-5));
  // reference phase: the x mode, half the split below the mean; the centrifugal term is 1e-11 Hz here
  const double split = 1e-3 * 1.02;
  EXPECT_NEAR(s.frequency_hz, f - 0.5 * split * std::cos(std::numbers::pi / 4.0), 1e-10);
  EXPECT_EQ(s.amplitude, 1.0);
  const double tau_s = 1e7 / (std::numbers::pi * f20) / 1.02;  // 2 % more damping at 30 degC
  EXPECT_NEAR(s.drive_v, 10.0 / 400.0 * 1.02 * (1.0 + 0.005 * std::cos(std::numbers::pi / 8.0)), 1e-14);
  EXPECT_NEAR(s.quadrature_v, 10.0 * split * std::sin(std::numbers::pi / 4.0) / 0.05, 1e-14);
  // zero-rate bias d sin 2th_tau/(2 kappa)
  const double bias = 0.01 / tau_s * std::sin(std::numbers::pi / 8.0) / (2.0 * 0.554);
  EXPECT_NEAR(s.rate_dph, 1000.0 + bias * 180.0 * 3600.0 / std::numbers::pi, 1e-9);
  EXPECT_EQ(s.rate_in_dph, 1000.0);
}

TEST(SlowTwin, TurningLowersTheFrequencyByTheCentrifugalTerm) {
  Environment e;
  const double at_rest = silent(Instrument{}, {}, {e}).front().frequency_hz;
  e.rate_dph = 100.0 * 3600.0;
  const double turning = silent(Instrument{}, {}, {e}).front().frequency_hz;
  const double w = 100.0 * std::numbers::pi / 180.0;
  EXPECT_NEAR(turning - at_rest, -0.11 * w * w / (2.0 * kTwoPi * at_rest) / kTwoPi, 2e-12);
}

TEST(SlowTwin, TheShellLagsTheCaseByAnExponential) {
  Instrument instrument;
  instrument.case_time_constant_s = 0.0;  // a step of the case itself
  const auto inputs = sample_inputs(
      [](double t_s) {
        Environment e;
        e.chamber_degc = t_s > 0.0 ? 10.0 : 20.0;
        return e;
      },
      0.0, 1e-3, 2);
  World world(instrument, {}, inputs[0], 0);
  Environment e = inputs[1];
  world.advance(e, 1.0);
  for (int i = 1; i <= 100; ++i) {
    e.time_s = 1e-3 + 60.0 * i;
    world.advance(e, 1.0);
    // the ramp of a millisecond acts like a step in its middle
    const double expected = 10.0 + 10.0 * std::exp(-(e.time_s - 0.5e-3) / 2600.0);
    EXPECT_NEAR(world.conditions().temperatures.shell_degc, expected, 1e-11);
  }
}

/// A PI loop around an integrator in small steps (midpoint rule), averaged over intervals: another way to the
/// same.
class SteppedLoop {
 public:
  explicit SteppedLoop(double bandwidth_hz, double start) : value_(start) {
    // crossover wc with the zero at wc/10, found by trying: |T|^2 = 1/2 at the bandwidth
    double low = 0.1 * bandwidth_hz;
    double high = 10.0 * bandwidth_hz;
    for (int i = 0; i < 100; ++i) {
      const double wc = kTwoPi * 0.5 * (low + high);
      k_ = wc / std::sqrt(1.01);
      z_ = 0.1 * wc;
      const double w = kTwoPi * bandwidth_hz;
      const double numerator = k_ * k_ * (w * w + z_ * z_);
      const double denominator = std::pow(k_ * z_ - w * w, 2) + k_ * k_ * w * w;
      (numerator / denominator < 0.5 ? low : high) = 0.5 * (low + high);
    }
  }

  /// Averages of the output, of its square, over the interval; and the change over it.
  struct Result {
    double mean;
    double square;
    double change;
  };
  Result run(double setpoint, double interval_s) {
    constexpr int kSteps = 20000;
    const double h = interval_s / kSteps;
    const double start = value_;
    Result r{0.0, 0.0, 0.0};
    for (int i = 0; i < kSteps; ++i) {
      const double e = setpoint - value_;
      const double middle = value_ + 0.5 * h * k_ * (e + z_ * integral_);
      const double middle_integral = integral_ + 0.5 * h * e;
      value_ += h * k_ * (setpoint - middle + z_ * middle_integral);
      integral_ += h * (setpoint - middle);
      r.mean += middle / kSteps;
      r.square += middle * middle / kSteps;
    }
    r.change = value_ - start;
    return r;
  }

 private:
  double k_ = 0.0;
  double z_ = 0.0;
  double value_;
  double integral_ = 0.0;
};

TEST(SlowTwin, AmplitudeStepsHaveTheTransientOfTheLoop) {
  for (const double interval_s : {0.05, 1.0}) {
    SCOPED_TRACE(interval_s);
    Instrument instrument;
    instrument.case_time_constant_s = 0.0;
    const auto inputs = sample_inputs(
        [](double t_s) {
          Environment e;
          e.amplitude_setpoint = t_s < 2.0 ? 1.0 : 0.95;
          return e;
        },
        0.0, interval_s, static_cast<std::size_t>(20.0 / interval_s));
    const auto telemetry = silent(instrument, {{"duffing", {{"relative_shift", 1e-6}}}}, inputs);
    const double drive_v = 10.0 / 400.0 * (1.0 + 0.005 * std::cos(std::numbers::pi / 8.0));
    SteppedLoop loop(0.5, 1.0);
    const double f0 = telemetry.front().frequency_hz;
    for (std::size_t i = 0; i < telemetry.size(); ++i) {
      const auto expected = loop.run(inputs[i].amplitude_setpoint, interval_s);
      EXPECT_NEAR(telemetry[i].amplitude, expected.mean, 1e-9) << i;
      // tau at 20 degC is 1.6e-3 below that at f = 4424.9 Hz; drive of A' in the first sample is 30 times the
      // settled one
      const double settled = drive_v * expected.mean;
      const double growth_v =
          10.0 / 400.0 * (1e7 / (std::numbers::pi * 4432.06628)) * expected.change / interval_s;
      EXPECT_NEAR(telemetry[i].drive_v, settled + growth_v, 1e-5 * std::abs(growth_v) + 1e-10) << i;
      // A^2 by Simpson's rule: within 1 % of the transient's size of 0.1 x 4.4 mHz
      EXPECT_NEAR(telemetry[i].frequency_hz - f0, f0 * 1e-6 * (expected.square - 1.0),
                  0.001 * 0.1 * f0 * 1e-6)
          << i;
    }
  }
}

TEST(SlowTwin, RateStepsHaveTheTransientOfTheRebalanceLoop) {
  const auto inputs = sample_inputs(
      [](double t_s) {
        Environment e;
        e.rate_dph = t_s < 0.0499 ? 0.0 : 3600.0;
        return e;
      },
      0.0, 0.005, 60);
  const auto telemetry = silent(Instrument{}, {}, inputs);
  SteppedLoop loop(40.0, 0.0);
  for (std::size_t i = 0; i < telemetry.size(); ++i) {
    EXPECT_NEAR(telemetry[i].rate_dph - telemetry[0].rate_dph, loop.run(inputs[i].rate_dph, 0.005).mean,
                3600.0 * 1e-7);
  }
  // the settled value; overshoot on the way
  EXPECT_GT(telemetry[14].rate_dph, 3600.0 * 1.05);
}

TEST(SlowTwin, QuadratureStepsHaveTheTransientOfTheQuadratureLoop) {
  // An angular acceleration acts like a split: - kappa W'/w. It steps; the rate itself is of no consequence
  // here.
  const auto inputs = sample_inputs(
      [](double t_s) {
        Environment e;
        e.rate_slope_dph_s = t_s < 0.99 ? 0.0 : -2e5;
        return e;
      },
      0.0, 0.1, 60);
  const auto telemetry = silent(Instrument{}, {}, inputs);
  const double w = kTwoPi * (telemetry[0].frequency_hz + 0.5e-3 * std::cos(std::numbers::pi / 4.0));
  const double size_v = 0.554 * 2e5 * kRadPerSecondPerDph / w / kTwoPi / 0.05 * 10.0;
  SteppedLoop loop(1.0, 0.0);
  for (std::size_t i = 0; i < telemetry.size(); ++i) {
    const double expected = loop.run(inputs[i].rate_slope_dph_s == 0.0 ? 0.0 : size_v, 0.1).mean;
    EXPECT_NEAR(telemetry[i].quadrature_v - telemetry[0].quadrature_v, expected, 1e-7 * size_v);
  }
}

TEST(SlowTwin, TrimOffsetsTheQuadratureCommandAndNothingElse) {
  const auto profile = [](double trim_v) {
    return sample_inputs(
        [trim_v](double t_s) {
          Environment e;
          e.quadrature_trim_v = t_s < 4.5 ? 0.0 : trim_v;
          return e;
        },
        0.0, 1.0, 10);
  };
  const auto without = silent(Instrument{}, {}, profile(0.0));
  const auto with = silent(Instrument{}, {}, profile(0.3));
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_NEAR(with[i].quadrature_v - without[i].quadrature_v, i < 5 ? 0.0 : 0.3, 1e-15);
    EXPECT_EQ(with[i].rate_dph, without[i].rate_dph);
    EXPECT_EQ(with[i].frequency_hz, without[i].frequency_hz);
    EXPECT_EQ(with[i].drive_v, without[i].drive_v);
  }
}

TEST(LoopResponse, IsDownByThreeDecibelsAtItsBandwidth) {
  for (const double bandwidth_hz : {0.5, 1.0, 40.0}) {
    const double w = kTwoPi * bandwidth_hz;
    const double dt_s = 1.0 / (2000.0 * bandwidth_hz);
    LoopResponse loop(LoopGains::of_bandwidth(bandwidth_hz), dt_s);
    loop.settle(0.0);
    double in_phase = 0.0;
    double quadrature = 0.0;
    // forty periods to settle (the slow mode decays in about a period), one to measure
    for (int i = 0; i < 41 * 2000; ++i) {
      const double t = (i + 0.5) * dt_s;
      loop.advance(std::sin(w * t), w * std::cos(w * t));
      if (i >= 40 * 2000) {
        in_phase += loop.mean() * std::sin(w * t) / 1000.0;
        quadrature += loop.mean() * std::cos(w * t) / 1000.0;
      }
    }
    // straight pieces of 1/2000 of a period: (2 pi/2000)^2/12 relative
    EXPECT_NEAR(std::hypot(in_phase, quadrature), std::sqrt(0.5), 2e-6);
  }
}

TEST(SlowTwin, RefusesInputsThatItCannotTake) {
  std::vector<Environment> inputs(3);
  inputs[1].time_s = 1.0;
  inputs[2].time_s = 2.5;
  EXPECT_THROW(silent(Instrument{}, {}, inputs), std::invalid_argument);
  // 4/pi of the clipping level is all that the fundamental of a square wave has
  Environment loud;
  loud.amplitude_setpoint = 1.2;
  EXPECT_THROW(silent(Instrument{}, {{"adc_saturation", {{"level", 0.72}}}}, {loud}), std::invalid_argument);
  EXPECT_TRUE(silent(Instrument{}, {}, {}).empty());
}

}  // namespace
}  // namespace hemi::physics

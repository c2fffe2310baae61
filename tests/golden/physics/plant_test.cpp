// SPDX-License-Identifier: Apache-2.0
// The plant from its words: timing, scale of every actuator, clock, updates.
#include "golden/physics/plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "tests/golden/physics/plant_support.hpp"

namespace hemi::physics {
namespace {

using Complex = std::complex<double>;

using testing::lossless;
using testing::ringing;
using testing::silent;

constexpr double kPi = std::numbers::pi;

std::int16_t word(double fraction) {
  return static_cast<std::int16_t>(std::lround(fraction * 32768.0));
}

// Complex amplitudes over `samples` with words that depend on the carrier's phase at the middle of the
// interval in which they act, instants n + 2 to n + 3; the sine held over a sample is weaker by sin(h)/h, h
// half the carrier's angle a sample.
struct Amplitudes {
  Complex x;
  Complex y;
};

Amplitudes run(Plant& plant, int samples, const std::function<DacWords(double angle_rad)>& words) {
  const double omega_rad_s = plant.parameters().omega_rad_s;
  const double step_s = 1e-5;
  for (int n = 0; n < samples; ++n) plant.act(words(omega_rad_s * step_s * (n + 2.5)));
  const Motion m = plant.motion();
  const Complex frame = std::polar(1.0, -std::fmod(omega_rad_s * step_s * samples, 2.0 * kPi));
  return {Complex(m.x, -m.x_rate_per_s / omega_rad_s) * frame,
          Complex(m.y, -m.y_rate_per_s / omega_rad_s) * frame};
}

double held(double omega_rad_s) {
  const double half_angle = omega_rad_s * 1e-5 / 2.0;
  return std::sin(half_angle) / half_angle;
}

// One second: the ripple 1/(w t) of what grows, and words rounded to 2^-16 of full scale at the most, whose
// errors are random from sample to sample.
constexpr int kSecond = 100000;
constexpr double kRelative = 1e-4;

TEST(Plant, WordsActFromTheSecondInstantAfterTheirSampleForOne) {
  const Instrument instrument = silent();
  const Parameters p = lossless(instrument);
  Plant plant(instrument, p, PlantConfiguration{});
  for (int n = 0; n < 10; ++n) plant.act({});
  plant.act({16384, 0, 0});  // computed from sample 10; now at instant 11
  EXPECT_EQ(plant.motion().x, 0.0);
  plant.act({});  // instant 12: the word begins to act
  EXPECT_EQ(plant.motion().x, 0.0);
  plant.act({});  // instant 13
  const double force = 2.0 * p.omega_rad_s * p.drive_per_s * 0.5;
  const double angle = p.omega_rad_s * 1e-5;
  const double rate_after = force / p.omega_rad_s * std::sin(angle);
  EXPECT_NEAR(plant.motion().x, force * (1.0 - std::cos(angle)) / (p.omega_rad_s * p.omega_rad_s), 1e-18);
  EXPECT_NEAR(plant.motion().x_rate_per_s, rate_after, 1e-12);
  plant.act({});  // instant 14: free again
  EXPECT_NEAR(
      plant.motion().x_rate_per_s,
      rate_after * std::cos(angle) - force / p.omega_rad_s * (1.0 - std::cos(angle)) * std::sin(angle),
      1e-12);
}

TEST(Plant, DriveMakesThePrimaryGrow) {
  const Instrument instrument = silent();
  const Parameters p = lossless(instrument);
  Plant plant(instrument, p, ringing());
  const double drive = 0.5;
  const Amplitudes end = run(plant, kSecond, [&](double angle) {
    return DacWords{word(-drive * std::sin(angle)), 0, 0};
  });
  // 400 x the steady drive at 1e7: 400 w / 2e7 a second
  const double growth = drive * 400.0 * p.omega_rad_s / 2e7 * held(p.omega_rad_s);
  EXPECT_NEAR((end.x.real() - 1.0) / growth, 1.0, kRelative);
  EXPECT_NEAR(end.x.imag() / growth, 0.0, kRelative);
  EXPECT_NEAR(std::abs(end.y), 0.0, 1e-12);
}

TEST(Plant, RebalanceFullScaleIsARate) {
  const Instrument instrument = silent();
  Parameters p = lossless(instrument);
  p.rate_rad_s = 60.0 * kPi / 180.0;
  p.centrifugal = 0.0;
  const double fraction = 60.0 / 120.0 / held(p.omega_rad_s);
  const auto rebalance = [&](double angle) { return DacWords{0, word(-fraction * std::sin(angle)), 0}; };
  Plant balanced(instrument, p, ringing());
  const double kept = run(balanced, kSecond / 10, rebalance).y.real();
  Plant free(instrument, p, ringing());
  const double lost = run(free, kSecond / 10, [](double) { return DacWords{}; }).y.real();
  EXPECT_LT(lost, -0.05);  // rate positive: -kappa W X
  EXPECT_NEAR(kept / lost, 0.0, 10.0 * kRelative);
}

// In force-to-rebalance the force that keeps y at zero is the zero-rate bias d sin 2th_tau / (2 kappa).
TEST(Plant, RebalanceThatHoldsTheSecondaryIsTheZeroRateBias) {
  const Instrument instrument = silent();
  Parameters p = lossless(instrument);
  p.mismatch_sin_per_s = 0.3;
  const double bias_rad_s = 0.3 / (2.0 * p.kappa);
  const double fraction = bias_rad_s / (120.0 * kPi / 180.0) / held(p.omega_rad_s);
  Plant plant(instrument, p, ringing());
  const Amplitudes end = run(plant, kSecond / 10, [&](double angle) {
    return DacWords{0, word(-fraction * std::sin(angle)), 0};
  });
  EXPECT_NEAR(std::abs(end.y) / (p.mismatch_sin_per_s / 2.0 * 0.1), 0.0, 10.0 * kRelative);
}

TEST(Plant, MisalignedDriveActsOnTheSecondary) {
  const Instrument instrument = silent();
  Parameters p = lossless(instrument);
  p.forcer_misalignment_rad = 0.02;
  Plant plant(instrument, p, ringing());
  const Amplitudes end = run(plant, kSecond, [](double angle) {
    return DacWords{word(-0.5 * std::sin(angle)), 0, 0};
  });
  EXPECT_NEAR(end.y.real() / (end.x.real() - 1.0) / 0.02, 1.0, kRelative);
}

// 25 mHz of split and half of the electrode's 50 mHz against it
TEST(Plant, QuadratureElectrodeTakesTheSplitAway) {
  const Instrument instrument = silent();
  Parameters p = lossless(instrument);
  p.split_sin_rad_s = 2.0 * kPi * 0.025;
  Plant cancelled(instrument, p, ringing());
  Plant split(instrument, p, ringing());
  const double rest = std::abs(run(cancelled, kSecond, [](double) { return DacWords{0, 0, word(-0.5)}; }).y);
  const Complex quadrature = run(split, kSecond, [](double) { return DacWords{}; }).y;
  EXPECT_NEAR(quadrature.imag(), -std::sin(p.split_sin_rad_s / 2.0), kRelative);
  EXPECT_LT(rest, 1e-3 * std::abs(quadrature));
}

// y > 0: the clock is fast, a cycle of the resonator spans fewer of its periods... and each holds less of a
// cycle.
TEST(Plant, FastClockCountsALowerFrequency) {
  const Instrument instrument = silent();
  Parameters p = lossless(instrument);
  p.oscillator_error = 2e-4;
  Plant plant(instrument, p, ringing());
  for (int n = 0; n < kSecond; ++n) plant.act({});
  const Motion m = plant.motion();
  const double nominal_angle = p.omega_rad_s * 1.0;
  const double counted = std::arg(Complex(m.x, -m.x_rate_per_s / p.omega_rad_s) *
                                  std::polar(1.0, -std::fmod(nominal_angle * (1.0 - 2e-4), 2.0 * kPi)));
  EXPECT_NEAR(counted, 0.0, 1e-7);
  EXPECT_NEAR(plant.time_s(), 1.0 - 2e-4, 1e-12);
}

TEST(Updates, AreAskedForTheMiddleOfTheirInterval) {
  std::vector<double> times;
  std::vector<double> amplitudes;
  const Instrument instrument = silent();
  PlantConfiguration configuration = ringing();
  configuration.start_s = 5.0;
  Plant plant(
      instrument,
      [&](double time_s, double amplitude) {
        times.push_back(time_s);
        amplitudes.push_back(amplitude);
        Parameters p = lossless(instrument);
        p.rate_rad_s = time_s;
        return p;
      },
      configuration);
  EXPECT_EQ(times.size(), 1u);
  for (int n = 0; n < 250; ++n) {
    EXPECT_NEAR(plant.time_s(), 5.0 + n * 1e-5, 1e-12);
    plant.act({});
  }
  ASSERT_EQ(times.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(times[i], 5.0 + (i + 0.5) * 1e-3, 1e-12);
  EXPECT_EQ(plant.parameters().rate_rad_s, times[2]);
  EXPECT_NEAR(amplitudes[2], 1.0, 1e-3);
}

TEST(Plant, RefusesImpossibleConfigurations) {
  const Instrument instrument;
  const auto make = [&](const std::function<void(PlantConfiguration&)>& change) {
    PlantConfiguration configuration;
    change(configuration);
    Plant(instrument, instrument.at(20.0), configuration);
  };
  EXPECT_NO_THROW(make([](PlantConfiguration&) {}));
  EXPECT_THROW(make([](PlantConfiguration& c) { c.adc.bits = 15; }), std::invalid_argument);
  EXPECT_THROW(make([](PlantConfiguration& c) { c.adc.rate_hz = 0.0; }), std::invalid_argument);
  EXPECT_THROW(make([](PlantConfiguration& c) { c.update_s = -1.0; }), std::invalid_argument);
}

}  // namespace
}  // namespace hemi::physics

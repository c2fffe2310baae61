// SPDX-License-Identifier: Apache-2.0
#include "golden/loops/noise_budget.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "golden/chain/modulator.hpp"
#include "golden/physics/noise.hpp"
#include "golden/physics/parameters.hpp"

namespace {

using namespace hemi;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kRecord_s = 0.005;
constexpr double kTick_s = 2e-4;

double squared(double x) {
  return x * x;
}

loops::NoiseBudget reference(const physics::Instrument& instrument = {},
                             const loops::ControlWishes& wishes = {}) {
  return {instrument, loops::CoreSampling::reference(), 16, wishes};
}

double carrier_hz() {
  return physics::Instrument().at(20.0).omega_rad_s / kTurn;
}

/// Weights of the ticks in one record: triangle of sum 1.
std::vector<double> triangle() {
  std::vector<double> w;
  for (int i = 1; i < 50; ++i) w.push_back(std::min(i, 50 - i) / 625.0);
  return w;
}

/// Weights in Hz a turn: mean phase of 25 ticks less that of the 25 before, over 5 ms.
std::vector<double> lambda() {
  std::vector<double> w(50, 8.0);
  std::fill(w.begin() + 25, w.end(), -8.0);
  return w;
}

/// (mean of the newer `averaged` records - mean of the older ones) / sqrt 2 as weights of ticks: their square
/// is the Allan variance.
std::vector<double> allan_weights(const std::vector<double>& record, int averaged) {
  std::vector<double> w(record.size() + static_cast<std::size_t>(25 * (2 * averaged - 1)));
  for (int r = 0; r < 2 * averaged; ++r) {
    const double sign = r < averaged ? 1.0 : -1.0;
    for (std::size_t i = 0; i < record.size(); ++i)
      w[static_cast<std::size_t>(25 * r) + i] += sign / (averaged * std::numbers::sqrt2) * record[i];
  }
  return w;
}

std::complex<double> response(const std::vector<double>& weights, double frequency_hz) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    sum += weights[i] * std::polar(1.0, -kTurn * frequency_hz * kTick_s * static_cast<double>(i));
  return sum;
}

TEST(NoiseBudget, IntegralIsThatOfTheFiltersWrittenOutTickByTick) {
  // Mid-point rule in steps of 0.05 Hz, fine for averaging times far below 1/0.05 Hz, against the closed
  // form.
  physics::Instrument instrument;
  instrument.oscillator_noise_rthz = 1e-10;
  const auto budget = reference(instrument);
  for (const int averaged : {1, 2, 7, 32}) {
    const auto of_rate = allan_weights(triangle(), averaged), of_phase = allan_weights(lambda(), averaged);
    double rate = 0.0, frequency = 0.0;
    constexpr double kStep_hz = 0.05;
    for (int i = 0; i < 50000; ++i) {
      const double f = (i + 0.5) * kStep_hz;
      rate += kStep_hz * budget.rate_density(f).total() * std::norm(response(of_rate, f));
      frequency += kStep_hz * budget.phase_density(f).total() * std::norm(response(of_phase, f));
    }
    EXPECT_NEAR(budget.rate_allan_variance(averaged).total(), rate, 1e-4 * rate) << averaged;
    EXPECT_NEAR(budget.frequency_allan_variance(averaged).total(), frequency, 1e-4 * frequency) << averaged;
  }
}

TEST(NoiseBudget, WhiteForceAndClockHaveTheirTextbookFloors) {
  // sigma^2 = S / (2 tau) for white noise of one-sided density S, once tau is far above loops and records.
  physics::Instrument instrument;
  instrument.oscillator_noise_rthz = 1e-10;
  const auto budget = reference(instrument);
  const double force_hz =
      instrument.kappa * instrument.force_noise_dph_rthz * physics::kRadPerSecondPerDph / kTurn;
  for (const long averaged : {20000L, 200000L}) {
    const double two_tau_s = 2.0 * kRecord_s * static_cast<double>(averaged);
    const auto rate = budget.rate_allan_variance(averaged);
    const auto frequency = budget.frequency_allan_variance(averaged);
    EXPECT_NEAR(rate.force * two_tau_s, squared(instrument.force_noise_dph_rthz), 1e-3 * 0.25);
    EXPECT_NEAR(frequency.force * two_tau_s / squared(force_hz), 1.0, 1e-3);
    EXPECT_NEAR(frequency.oscillator * two_tau_s / squared(carrier_hz() * 1e-10), 1.0, 1e-3);
  }
}

TEST(NoiseBudget, PickoffNoiseInThePhaseIsThatOfTheFiltersInTime) {
  // Without a phase loop worth the name the tracker sees the detector: q = -2 sum h n sin(theta) over G a.
  // Here in time: the weights of the ADC samples in the Allan difference, squared and summed.
  loops::ControlWishes wishes;
  wishes.reference_phase_hz = 0.05;
  const auto budget = reference({}, wishes);
  std::vector<double> h{1.0};
  const auto convolve = [](const std::vector<double>& a, const std::vector<double>& b, std::size_t step) {
    std::vector<double> c(a.size() + (b.size() - 1) * step);
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < b.size(); ++j) c[i + j * step] += a[i] * b[j];
    return c;
  };
  for (int i = 0; i < 5; ++i) h = convolve(h, std::vector<double>(20, 1.0 / 20.0), 1);
  h = convolve(h, {16.0 / 49.0, -8.0 / 49.0, 33.0 / 49.0, -8.0 / 49.0, 16.0 / 49.0}, 20);
  const double noise = std::ldexp(0.5, -15), amplitude = 0.8;
  for (const int averaged : {1, 2, 16}) {
    double squares = 0.0;
    for (const double w : convolve(h, allan_weights(lambda(), averaged), 20)) squares += w * w;
    // Samples are 0.8 of full scale; of 2 n sin half the square counts twice: 4 / 2.
    const double expected = squares * 2.0 * squared(noise / amplitude / kTurn);
    EXPECT_NEAR(budget.frequency_allan_variance(averaged).pickoff / expected, 1.0, 1e-4) << averaged;
    EXPECT_NEAR(budget.frequency_allan_variance(averaged).adc / expected, 1.0 / 3.0, 1e-4) << averaged;
  }
}

TEST(NoiseBudget, SlowPickoffNoiseInTheRateIsWhatTurnsThePattern) {
  // Far below the loop's bandwidth the command must make the motion follow the noise: a displacement n(t) of
  // the secondary takes a rate n' / (kappa a). Density S of n in phase: 2 x 2 sigma^2 / fs.
  const physics::Instrument instrument;
  const auto budget = reference();
  const double noise = std::ldexp(0.5, -15) / 0.8;
  const double in_phase = 4.0 * squared(noise) / 1e5;
  for (const double f : {0.1, 0.3, 1.0}) {
    const double rate_dph = kTurn * f / instrument.kappa / physics::kRadPerSecondPerDph;
    EXPECT_NEAR(budget.rate_density(f).pickoff / (in_phase * squared(rate_dph)), 1.0, 0.03) << f;
  }
}

TEST(NoiseBudget, ForceNoiseReachesTheRateUpToTheLoopsBandwidth) {
  // The loop is designed for half the power at 40 Hz.
  const auto budget = reference();
  const double density = squared(physics::Instrument().force_noise_dph_rthz);
  EXPECT_NEAR(budget.rate_density(40.0).force / density, 0.5, 1e-6);
  EXPECT_NEAR(budget.rate_density(0.01).force / density, 1.0, 1e-3);
  EXPECT_LT(budget.rate_density(400.0).force / density, 0.01);
}

TEST(NoiseBudget, SourcesScaleAsTheyShould) {
  physics::Instrument strong;
  strong.pickoff_noise_lsb *= 2.0;
  strong.force_noise_dph_rthz *= 3.0;
  const auto one = reference().rate_allan_variance(8), other = reference(strong).rate_allan_variance(8);
  EXPECT_NEAR(other.pickoff / one.pickoff, 4.0, 1e-9);
  EXPECT_NEAR(other.force / one.force, 9.0, 1e-9);
  EXPECT_EQ(other.adc, one.adc);
  EXPECT_EQ(other.dac, one.dac);
  // 18 bit at 250 kS/s: the same pickoff noise a root hertz, rounding 16 x 2.5 times less dense, the DAC's
  // slope at the carrier 2.5^2 less on a rounding 2.5 times less dense.
  const loops::NoiseBudget wide({}, loops::CoreSampling::wide(), 18);
  for (const long averaged : {2L, 64L}) {
    const auto w = wide.rate_allan_variance(averaged), r = reference().rate_allan_variance(averaged);
    EXPECT_NEAR(w.pickoff / r.pickoff, 1.0, 0.01);
    EXPECT_NEAR(w.adc / r.adc, 1.0 / 40.0, 0.01 / 40.0);
    EXPECT_NEAR(w.force / r.force, 1.0, 0.01);
    EXPECT_NEAR(w.dac / r.dac, std::pow(2.5, -3), 0.02 * std::pow(2.5, -3));
  }
}

TEST(NoiseBudget, DacRoundingIsThatOfTheModulatorAtTheCarrier) {
  // A command of a fifth of an LSB with the noise that the loop puts on it, tick by tick; the words' error in
  // phase with the carrier, averaged over 10 ms: variance S / (2 T).
  const auto budget = reference();
  double square = 0.0;
  for (int i = 0; i < 2500; ++i) square += budget.rate_density(i + 0.5).total();
  const physics::Instrument instrument;
  const double full_scale_dph = instrument.rebalance_full_scale_dps * 3600.0;
  const double deviation = std::sqrt(square) / full_scale_dph;
  EXPECT_GT(deviation, std::ldexp(1.0, -15)) << "too little to spread the rounding evenly";
  golden::ErrorFeedback feedback(golden::Precision::quantised);
  physics::Gaussian gaussian(4);
  constexpr int kBlock = 1000, kBlocks = 4000;
  double command = 0.0, sum = 0.0, squares = 0.0;
  for (int i = 0; i < kBlock * kBlocks; ++i) {
    if (i % 20 == 0) command = 0.2 * std::ldexp(1.0, -15) + deviation * gaussian();
    const double carrier = -std::sin(kTurn * std::fmod(i * carrier_hz() / 1e5, 1.0));
    sum += 2.0 * carrier * (feedback(command * carrier) - command * carrier);
    if (i % kBlock == kBlock - 1) {
      squares += squared(sum / kBlock);
      sum = 0.0;
    }
  }
  const double measured = squares / kBlocks * 2.0 * kBlock / 1e5 * squared(full_scale_dph);
  // The budget's part at 5 Hz, well inside the rebalance loop, has the hold's sinc in it: 0.32 %.
  const double predicted =
      budget.rate_density(5.0).dac /
      std::norm(loops::design_control(instrument, loops::CoreSampling::reference()).rebalance.closed(5.0));
  // 4000 blocks know a variance to 2.2 %. About 8 % of the samples, near the carrier's zeros, change the sum
  // by less than half an LSB: they carry the error over instead of drawing a new one.
  EXPECT_NEAR(measured / predicted, 1.0, 0.08 + 3.0 * 0.022);
  std::printf("DAC rounding: %.4g (deg/h)/rtHz, predicted %.4g; command's deviation %.1f LSB\n",
              std::sqrt(measured), std::sqrt(predicted), std::ldexp(deviation, 15));
}

TEST(NoiseBudget, RefusesWhatItCannotAnswer) {
  EXPECT_THROW(loops::NoiseBudget({}, loops::CoreSampling::reference(), 12), std::invalid_argument);
  const auto budget = reference();
  EXPECT_THROW(budget.rate_allan_dph(0.0123), std::invalid_argument);
  EXPECT_THROW(budget.frequency_allan_hz(0.0), std::invalid_argument);
  EXPECT_THROW(budget.rate_allan_dph(NAN), std::invalid_argument);
  EXPECT_DOUBLE_EQ(budget.rate_allan_dph(0.64), std::sqrt(budget.rate_allan_variance(128).total()));
}

}  // namespace

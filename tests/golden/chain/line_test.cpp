// SPDX-License-Identifier: Apache-2.0
// The 200 Hz frequency of the quantised chain: free of lines for a clean tone, and on a ramp where it should
// be.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "tests/golden/chain/support.hpp"

namespace hemi::golden::testing {
namespace {

using namespace config;
constexpr double kLineLimitHz = 10e-6;
constexpr double kScallop = 1.178;  // a line between two bins of a Hann window, 1.42 dB
constexpr double kDitherLsb = 0.5;
constexpr std::size_t kSettled = 400;

struct Lines {
  double largest_hz;
  double at_hz;  // of the 200 Hz output
  double rms_hz;
};

Lines lines_of(const InstrumentParameters& instrument, double frequency_hz, int seconds, double dither_lsb) {
  Chain chain(Precision::quantised, instrument, reference_values(instrument, frequency_hz));
  Tone tone(frequency_hz, instrument.adc_rate_hz, 0.8, 0.2);
  Noise noise(31);
  std::vector<ChainRecord> records;
  const auto second = static_cast<Eigen::Index>(instrument.adc_rate_hz);
  const Eigen::VectorXd y = Eigen::VectorXd::Zero(second);
  const double sigma = dither_lsb * power_of_two(1 - instrument.adc_bits);
  for (int s = 0; s < seconds; ++s) {
    chain.samples(digitise(tone.next(second) + noise.next(second, sigma), instrument.adc_bits), y, nullptr,
                  records);
  }
  const Eigen::VectorXd series = column(records, word_frequency, kSettled);
  const Eigen::VectorXd spectrum = line_spectrum(series);
  Eigen::Index bin = 0;
  const double largest =
      spectrum.tail(spectrum.size() - 3).maxCoeff(&bin);  // the window spreads the mean over two bins
  return {largest * kScallop,
          static_cast<double>(bin + 3) * output_rate_hz / static_cast<double>(series.size()),
          std::sqrt((series.array() - series.mean()).square().mean())};
}

constexpr std::array<double, 7> kFrequencies = {4365.0, 4400.0, 4425.0, 4444.4444444, 4450.0, 4471.3, 4485.0};

TEST(Lines, CleanToneWithDitherShowsNone) {
  constexpr int kSeconds = 132;  // 26000 outputs
  for (const double frequency : kFrequencies) {
    const Lines lines = lines_of(InstrumentParameters::reference(), frequency, kSeconds, kDitherLsb);
    // Noise alone: n outputs of standard deviation s have line amplitudes of mean square 4 s^2 / n times 1.5
    // for the window, up to 2 at 100 Hz where differenced phase noise is largest; the largest of n / 2
    // exponential powers is log(n / 2) times the mean.
    const double n = (kSeconds - 2) * 200.0;
    const double noise = kScallop * lines.rms_hz * std::sqrt(4.0 / n * 1.5 * 2.0 * std::log(n / 2.0));
    fmt::print("{:.4f} Hz: largest line {:.2e} Hz at {:.3f} Hz (noise alone {:.2e} Hz)\n", frequency,
               lines.largest_hz, lines.at_hz, noise);
    EXPECT_LE(lines.largest_hz, kLineLimitHz);
    EXPECT_LE(noise, kLineLimitHz) << "too short to tell";
  }
}

TEST(Lines, WithoutDitherTheAdcsRoundingShows) {
  // The rounding of a tone at a simple fraction of the ADC rate is periodic: its power falls into few lines,
  // which is no property of the chain. The ideal chain shows the same; half an LSB of angle bounds it.
  for (const double frequency : {4425.0, 4400.0, 4400.01, 4444.4444444 + 0.01, 4471.3}) {
    const auto instrument = InstrumentParameters::reference();
    const Lines lines = lines_of(instrument, frequency, 42, 0.0);
    const Eigen::VectorXd response = baseband_response(instrument.decimation);
    const double weight = spread(response, frequency_tick_weights(), instrument.decimation).lpNorm<1>();
    const double bound =
        8.0 * power_of_two(-instrument.adc_bits) * weight / (std::numbers::pi * 0.8 * response.sum());
    fmt::print("{:.4f} Hz without dither: largest line {:.2e} Hz at {:.3f} Hz (bound {:.1e} Hz)\n", frequency,
               lines.largest_hz, lines.at_hz, bound);
    EXPECT_LE(lines.largest_hz, 2.0 * kScallop * bound);
  }
}

// cos(2 pi (f t + ramp t^2 / 2)), its phase in long double: 2^-64 of 5e4 turns.
Eigen::VectorXd ramp_tone(const InstrumentParameters& instrument, double start_hz, double ramp_hz_per_s,
                          int seconds) {
  return Eigen::VectorXd::NullaryExpr(
      static_cast<Eigen::Index>(seconds * instrument.adc_rate_hz), [=](Eigen::Index n) {
        const long double t = static_cast<long double>(n) / static_cast<long double>(instrument.adc_rate_hz);
        const long double turns = t * (start_hz + ramp_hz_per_s * t / 2.0L);
        return 0.8 * std::cos(2.0 * std::numbers::pi * static_cast<double>(turns - std::floor(turns)));
      });
}

// Output m describes time sample (25 m - 4) R.
Eigen::ArrayXd ramp_error(const InstrumentParameters& instrument, Precision precision, double ramp_hz_per_s,
                          const Eigen::VectorXd& words, double start_hz) {
  Chain chain(precision, instrument, reference_values(instrument, start_hz));
  std::vector<ChainRecord> records;
  chain.samples(words, Eigen::VectorXd::Zero(words.size()), nullptr, records);
  Eigen::ArrayXd error = column(records, word_frequency, kSettled).array() - start_hz;
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    const double m = static_cast<double>(i) + kSettled;
    error[i] -= ramp_hz_per_s * (25.0 * m - 4.0) * instrument.decimation / instrument.adc_rate_hz;
  }
  return error;
}

TEST(Ramp, IsFollowedWithTheStatedLag) {
  constexpr double kRamp = 0.01;
  constexpr double kStart = 4425.1;  // within 2 Hz of where the image vanishes
  constexpr int kSeconds = 12;
  for (const auto& instrument : {InstrumentParameters::reference(), InstrumentParameters::wide()}) {
    const Eigen::VectorXd tone = ramp_tone(instrument, kStart, kRamp, kSeconds);
    const double full_scale = power_of_two(instrument.adc_bits - 1);
    const Eigen::ArrayXd ideal = ramp_error(instrument, Precision::ideal, kRamp, tone * full_scale, kStart);
    Noise noise(41);
    const Eigen::VectorXd words =
        digitise(tone + noise.next(tone.size(), kDitherLsb / full_scale), instrument.adc_bits);
    const Eigen::ArrayXd quantised = ramp_error(instrument, Precision::quantised, kRamp, words, kStart);
    // Ideal: exact, but for doubles (625 steps of words known to 2^-48 turns, times 8 Hz) and the image,
    // which theory_test bounds: below 1e-9 Hz this close to its zero. A lag wrong by one sample would show as
    // 40 to 100 nHz.
    const double sample_hz = kRamp / instrument.adc_rate_hz;
    // Quantised with noise: the mean over n outputs is the difference of two interval means of the phase,
    // each of white phase noise on 25 R samples; four standard deviations of it, and twice the budget of the
    // formats.
    const double samples = 25.0 * instrument.decimation;
    const double phase_turns = std::sqrt((kDitherLsb * kDitherLsb + 1.0 / 12.0) * 2.0 / samples) /
                               (0.8 * full_scale) / (2.0 * std::numbers::pi);
    const double n = static_cast<double>(quantised.size());
    const ChainBudget budget =
        quantisation_budget({instrument, 0.8, 0.0, 0.0}, reference_values(instrument, kStart));
    const double mean_limit =
        (4.0 * std::sqrt(2.0) * phase_turns + 2.0 * budget.detector_turns.worst) / (n / output_rate_hz);
    fmt::print(
        "{} bit, 10 mHz/s: ideal off by {:.2e} Hz, lag off by {:.4f} samples; quantised mean off by {:.2e} "
        "Hz "
        "(limit {:.2e}; one output's lag is {:.1e})\n",
        instrument.adc_bits, ideal.abs().maxCoeff(), ideal.mean() / sample_hz, quantised.mean(), mean_limit,
        kRamp / output_rate_hz);
    EXPECT_LE(ideal.abs().maxCoeff(), 1e-9);
    EXPECT_LE(std::abs(quantised.mean()), mean_limit);
    EXPECT_LT(mean_limit, kRamp / output_rate_hz / 25.0) << "a tick's lag must show";
  }
}

}  // namespace
}  // namespace hemi::golden::testing

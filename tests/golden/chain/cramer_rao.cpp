// SPDX-License-Identifier: Apache-2.0
#include "tests/golden/chain/cramer_rao.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <numbers>

namespace hemi::golden::testing {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Eigen::Index kOutputs = config::output_rate_hz;  // in a piece
constexpr int kSettlingSeconds = 2;

// Standard deviation of a frequency from N samples of a real tone: var = 12 / (snr N (N^2 - 1))
// (rad/sample)^2.
double cramer_rao_hz(double samples, double snr, double adc_rate_hz) {
  return std::sqrt(12.0 / (snr * samples * (samples * samples - 1.0))) / (2.0 * kPi) * adc_rate_hz;
}

// The estimate is a weighted sum of products: weights of the line through 200 phases, each the mean of 25
// ticks, each the response of the filters. Noise across the carrier has half the noise's variance.
double theoretical_hz(const RaoCase& c, double amplitude, double sigma) {
  const auto last = static_cast<double>(kOutputs - 1);
  Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(kOutputs, -last / 2.0, last / 2.0);
  line /= line.squaredNorm();
  const Eigen::VectorXd mean =
      Eigen::VectorXd::Constant(config::ticks_per_output, 1.0 / config::ticks_per_output);
  const Eigen::VectorXd response = baseband_response(c.instrument.decimation);
  const Eigen::VectorXd weights = spread(
      response / response.sum(), spread(mean, line, config::ticks_per_output), c.instrument.decimation);
  return config::output_rate_hz * weights.norm() * sigma / std::sqrt(2.0) / (2.0 * kPi * amplitude / 2.0);
}

}  // namespace

RaoResult run_rao(const RaoCase& c) {
  const double amplitude = std::pow(10.0, -1.0 / 20.0);
  const double snr = std::pow(10.0, c.snr_db / 10.0);
  const double total = amplitude * amplitude / 2.0 / snr;
  const double rounding = std::pow(power_of_two(1 - c.instrument.adc_bits), 2) / 12.0;
  Chain chain(Precision::quantised, c.instrument, reference_values(c.instrument, c.frequency_hz));
  Tone tone(c.frequency_hz, c.instrument.adc_rate_hz, amplitude, 0.3);
  Noise noise(c.seed);
  const auto second = static_cast<Eigen::Index>(c.instrument.adc_rate_hz);
  const Eigen::VectorXd y = Eigen::VectorXd::Zero(second);
  Eigen::VectorXd estimates(c.pieces);
  for (int piece = -kSettlingSeconds; piece < c.pieces; ++piece) {
    std::vector<ChainRecord> records;
    chain.samples(
        digitise(tone.next(second) + noise.next(second, std::sqrt(total - rounding)), c.instrument.adc_bits),
        y, nullptr, records);
    if (piece < 0) continue;
    Eigen::VectorXd phase = column(records, config::word_frequency).array() - c.frequency_hz;
    for (Eigen::Index i = 1; i < phase.size(); ++i) phase[i] += phase[i - 1];
    estimates[piece] = line_slope(phase);
  }
  const double bias = estimates.mean();
  return {std::sqrt((estimates.array() - bias).square().sum() / (c.pieces - 1)), bias,
          cramer_rao_hz(c.instrument.adc_rate_hz, snr, c.instrument.adc_rate_hz),
          theoretical_hz(c, amplitude, std::sqrt(total))};
}

void expect_efficient(const RaoCase& c) {
  const RaoResult r = run_rao(c);
  fmt::print(
      "{} bit {:.4f} Hz, {:.0f} dB, {} pieces: deviation {:.3e} Hz = {:.3f} bounds (theory {:.4f}), bias "
      "{:+.1e} Hz\n",
      c.instrument.adc_bits, c.frequency_hz, c.snr_db, c.pieces, r.deviation_hz, r.deviation_hz / r.bound_hz,
      r.theory_hz / r.bound_hz, r.bias_hz);
  EXPECT_LE(r.deviation_hz, 1.12 * r.bound_hz);
  EXPECT_LE(r.theory_hz, 1.12 * r.bound_hz);
  EXPECT_LE(std::abs(r.bias_hz), 1e-6);
  // Better than the bound only by chance: four standard errors of a standard deviation.
  EXPECT_GE(r.deviation_hz, r.bound_hz * (1.0 - 4.0 / std::sqrt(2.0 * c.pieces)));
}

}  // namespace hemi::golden::testing

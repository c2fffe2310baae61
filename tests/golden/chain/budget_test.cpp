// SPDX-License-Identifier: Apache-2.0
// The quantised chain against the ideal one: within the budget of the formats, and hardly noisier.
#include "golden/chain/budget.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "tests/golden/chain/support.hpp"

namespace hemi::golden::testing {
namespace {

using namespace config;
// Of full scale: half an LSB of the reference instrument, for both.
constexpr double kPickoffNoise = 0.5 / 32768.0;
constexpr std::size_t kSettled = 400;

struct Pair {
  OperatingPoint point;
  RegisterValues values;
  std::vector<ChainRecord> ideal;
  std::vector<ChainRecord> quantised;
};

// rebalance_gain: 0 in open loop, else that of a rebalance loop without integral.
Pair run_pair(const InstrumentParameters& instrument, double frequency_hz, int seconds, double sigma,
              unsigned seed, double rebalance_gain = 0.0) {
  Pair pair{{instrument, 0.8, 0.3, 0.6}, reference_values(instrument, frequency_hz), {}, {}};
  pair.values[reg_demodulation_cos] = 0.75;
  pair.values[reg_demodulation_sin] = 0.625;
  if (rebalance_gain != 0.0) {
    pair.values[reg_control] = 1.0;
    pair.values[reg_demodulation_cos] = -0.75;  // a positive command
    pair.values[reg_demodulation_sin] = -0.625;
    pair.values[reg_rate_gain] = 512.0;  // the steps of the command are to show, not those of the rate word
    pair.values[reg_search_amplitude] = pair.values[reg_closing_amplitude] = 0.125;
    pair.values[reg_search_ticks] = 1e6;
    pair.values[reg_holdover_ticks] = 1e6;
    pair.values[reg_rebalance_limit] = 1.5;
    pair.values[reg_rebalance_proportional] = round_to(rebalance_gain, 13);
  }
  Chain ideal(Precision::ideal, instrument, pair.values);
  Chain quantised(Precision::quantised, instrument, pair.values);
  Tone x(frequency_hz, instrument.adc_rate_hz, pair.point.primary_amplitude, 0.1);
  Tone y(frequency_hz, instrument.adc_rate_hz, pair.point.secondary_amplitude,
         0.1 + pair.point.secondary_phase_rad / (2.0 * std::numbers::pi));
  Noise noise(seed);
  const auto chunk = static_cast<Eigen::Index>(instrument.adc_rate_hz);
  for (int second = 0; second < seconds; ++second) {
    const Eigen::VectorXd xw = digitise(x.next(chunk) + noise.next(chunk, sigma), instrument.adc_bits);
    const Eigen::VectorXd yw = digitise(y.next(chunk) + noise.next(chunk, sigma), instrument.adc_bits);
    ideal.samples(xw, yw, nullptr, pair.ideal);
    quantised.samples(xw, yw, nullptr, pair.quantised);
  }
  return pair;
}

struct Measured {
  RecordWord word;
  const char* name;
  Budget ChainBudget::*budget;
  double worst = 0.0;
  double sum_of_squares = 0.0;
  double count = 0.0;
  void add(const Pair& pair) {
    const Eigen::ArrayXd difference =
        column(pair.quantised, word, kSettled) - column(pair.ideal, word, kSettled);
    worst = std::max(worst, difference.abs().maxCoeff());
    sum_of_squares += difference.square().sum();
    count += static_cast<double>(difference.size());
  }
};

class Quantisation : public ::testing::TestWithParam<int> {
 protected:
  static InstrumentParameters instrument() {
    return GetParam() == 0 ? InstrumentParameters::reference() : InstrumentParameters::wide();
  }
};

TEST_P(Quantisation, StaysWithinTheBudgetOfTheFormats) {
  constexpr int kFrequencies = 24;
  std::array<Measured, 4> words = {
      {{word_frequency, "frequency [Hz]", &ChainBudget::frequency_hz},
       {word_amplitude, "amplitude [sum]", &ChainBudget::amplitude_sum},
       {word_phase_error, "phase error [turns, sum]", &ChainBudget::phase_error_sum_turns},
       {word_rate, "rate [1/625 of full scale]", &ChainBudget::rate_dph}}};
  ChainBudget budget{};
  for (int i = 0; i < kFrequencies; ++i) {
    const Pair pair =
        run_pair(instrument(), 4365.37 + 5.00713 * i, 6, kPickoffNoise, 100U + static_cast<unsigned>(i));
    budget = quantisation_budget(pair.point, pair.values);
    for (Measured& word : words) word.add(pair);
  }
  fmt::print(
      "{} bit budget, worst and rms: nco {:.2e} {:.2e}, baseband {:.2e} {:.2e}, detector {:.2e} {:.2e} "
      "turns\n",
      instrument().adc_bits, budget.nco.worst, budget.nco.rms, budget.baseband.worst, budget.baseband.rms,
      budget.detector_turns.worst, budget.detector_turns.rms);
  // At one frequency the nco's errors are lines. Those of its 512 rounded values lie below harmonic 2048:
  // 2048 odd ones of either sign, folded evenly over the ADC rate, of which those within 200 Hz of the
  // carrier count. Their powers scatter like exponential variables: the sum of n by 1 / sqrt n, its root by
  // half of that; four times that.
  const double lines = kFrequencies * 2048.0 * 400.0 / instrument().adc_rate_hz;
  for (const Measured& word : words) {
    const Budget& allowed = budget.*word.budget;
    const double rms = std::sqrt(word.sum_of_squares / word.count);
    fmt::print("  {:27s} worst {:.2e} (budget {:.2e}), rms {:.2e} (budget {:.2e})\n", word.name, word.worst,
               allowed.worst, rms, allowed.rms);
    EXPECT_LE(word.worst, allowed.worst) << word.name;
    EXPECT_LE(rms, allowed.rms * (1.0 + 2.0 / std::sqrt(lines))) << word.name;
    EXPECT_GT(rms, 0.0) << word.name;
  }
}

TEST_P(Quantisation, RateOfTheRebalanceCommandStaysWithinItsBudget) {
  constexpr int kFrequencies = 4;
  for (const double gain : {0.01, 8.0}) {  // the command's floor counts; it does not
    Measured rate{word_rate, "rate", &ChainBudget::rate_dph};
    Budget allowed{};
    for (int i = 0; i < kFrequencies; ++i) {
      const Pair pair = run_pair(instrument(), 4365.37 + 30.00713 * i, 4, kPickoffNoise,
                                 200U + static_cast<unsigned>(i), gain);
      allowed = quantisation_budget(pair.point, pair.values).rate_dph;
      EXPECT_GT(column(pair.ideal, word_rate, kSettled).minCoeff(), 0.0);
      rate.add(pair);
    }
    const double rms = std::sqrt(rate.sum_of_squares / rate.count);
    fmt::print("{} bit, rebalance gain {}: rate worst {:.2e} (budget {:.2e}), rms {:.2e} (budget {:.2e})\n",
               instrument().adc_bits, gain, rate.worst, allowed.worst, rms, allowed.rms);
    // Lines of the nco's table as above, of fewer frequencies.
    const double lines = kFrequencies * 2048.0 * 400.0 / instrument().adc_rate_hz;
    EXPECT_LE(rate.worst, allowed.worst);
    EXPECT_LE(rms, allowed.rms * (1.0 + 2.0 / std::sqrt(lines)));
    EXPECT_GT(rms, 0.0);
  }
}

double variance(const std::vector<ChainRecord>& records, RecordWord word) {
  const Eigen::ArrayXd values = column(records, word, kSettled);
  return (values - values.mean()).square().mean();
}

// The same noise in both: the ratio of the variances is known far better than either.
double added_noise_db(const Pair& pair, RecordWord word) {
  return 10.0 * std::log10(variance(pair.quantised, word) / variance(pair.ideal, word));
}

TEST_P(Quantisation, AddsHardlyAnyNoise) {
  const Pair pair = run_pair(instrument(), 4425.1234567, 42, kPickoffNoise, 12);
  const ChainBudget budget = quantisation_budget(pair.point, pair.values);
  const double budget_db =
      10.0 * std::log10(1.0 + std::pow(budget.frequency_hz.rms, 2) / variance(pair.ideal, word_frequency));
  fmt::print(
      "{} bit: frequency noise {:.2e} Hz, added {:.4f} dB (budget {:.4f} dB); rate noise added {:.4f} dB\n",
      instrument().adc_bits, std::sqrt(variance(pair.ideal, word_frequency)),
      added_noise_db(pair, word_frequency), budget_db, added_noise_db(pair, word_rate));
  EXPECT_LE(std::abs(added_noise_db(pair, word_frequency)), 0.1);
  EXPECT_LE(std::abs(added_noise_db(pair, word_rate)), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Both, Quantisation, ::testing::Values(0, 1),
                         [](const auto& suite) { return suite.param == 0 ? "Reference" : "Wide"; });

}  // namespace
}  // namespace hemi::golden::testing

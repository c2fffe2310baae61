// SPDX-License-Identifier: Apache-2.0
// Force to rebalance: every tap and every DAC word against whole numbers, through every branch of start_up
// and of the actuator loops.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/golden/chain/contract.hpp"

namespace hemi::golden::testing {
namespace {

using namespace config;

constexpr double kStartHz = 4425.0;

// Amplitudes below, between and above the three thresholds of closing_registers (the word of a tone of a is
// about 0.48 a), with the frequency right or far off, in pieces of random length.
class Pieces {
 public:
  Pieces(const InstrumentParameters& instrument, unsigned seed) : instrument_(instrument), random_(seed) {}

  std::pair<double, double> next() {
    if (left_ == 0) draw();
    --left_;
    turns_ = modulo(turns_ + frequency_hz_ / instrument_.adc_rate_hz, 1.0);
    const double x = amplitude_ * std::cos(2.0 * std::numbers::pi * turns_) + 1e-4 * uniform(random_);
    const double y = std::cos(2.0 * std::numbers::pi * (turns_ + secondary_turns_));
    const double full_scale = power_of_two(instrument_.adc_bits - 1);
    const auto word = [=](double v) {
      return std::clamp(std::floor(v * full_scale + 0.5), -full_scale, full_scale - 1.0);
    };
    return {word(x), word(square_ ? std::copysign(1.0, y) : secondary_ * y)};
  }

 private:
  void draw() {
    constexpr std::array<double, 4> kAmplitudes = {0.0, 0.08, 0.3, 0.8};
    left_ =
        static_cast<int>(20 + random_() % 400) * instrument_.decimation + static_cast<int>(random_() % 20);
    amplitude_ = kAmplitudes[std::min<std::size_t>(random_() % 6, 3)];
    frequency_hz_ = kStartHz + (random_() % 4 == 0 ? 300.0 : 5.0) * uniform(random_);
    secondary_ = std::pow(10.0, -4.0 + 2.0 * (1.0 + uniform(random_)));
    secondary_turns_ = uniform(random_);
    square_ = random_() % 4 == 0;
    if (random_() % 2 == 0) turns_ = uniform(random_);
  }

  InstrumentParameters instrument_;
  std::mt19937_64 random_;
  int left_ = 0;
  double amplitude_ = 0.0;
  double frequency_hz_ = 0.0;
  double secondary_ = 0.0;
  double secondary_turns_ = 0.0;
  double turns_ = 0.0;
  bool square_ = false;
};

// A loop that locks, thresholds, counts and limits that the pieces cross; gains over four decades up to the
// highest.
RegisterValues closing_registers(const InstrumentParameters& instrument, std::mt19937_64& random) {
  RegisterValues values = reference_values(instrument, kStartHz);
  const auto positive = [&random] { return 0.5 + 0.5 * uniform(random); };
  const auto gain = [&](RegisterIndex i) {
    values[i] = highest_of(registers[i].format) * std::pow(10.0, -4.0 * positive());
  };
  values[reg_lock_count] = 15.0;
  values[reg_amplitude_threshold] = 0.02;
  values[reg_search_amplitude] = 0.08;
  values[reg_closing_amplitude] = 0.25;
  values[reg_search_ticks] = std::floor(5.0 + 20.0 * positive());
  values[reg_search_step] = 30.0 * positive() / instrument.adc_rate_hz;
  values[reg_search_span] = 75.0 * positive() / instrument.adc_rate_hz;
  values[reg_holdover_ticks] = std::floor(20.0 + 60.0 * positive());
  values[reg_control] = random() % 8 == 0 ? 2.0 : std::array{1.0, -1.0, 7.0}[random() % 3];
  values[reg_modulation_phase] = 0.499 * uniform(random);
  values[reg_modulation_delay] = 31.9 * uniform(random);
  values[reg_amplitude_setpoint] = random() % 4 == 0 ? 1.9 * uniform(random) : 0.3;
  for (const RegisterIndex i :
       {reg_amplitude_proportional, reg_amplitude_integral, reg_quadrature_proportional,
        reg_quadrature_integral, reg_rebalance_proportional, reg_rebalance_integral, reg_rate_gain}) {
    gain(i);
    if (random() % 8 == 0) values[i] = -values[i];
  }
  values[reg_drive_start] = 1.5 * uniform(random);
  values[reg_quadrature_start] = 1.5 * uniform(random);
  values[reg_drive_limit] = 1.999 * positive();
  values[reg_quadrature_limit] = 1.999 * positive();
  values[reg_rebalance_limit] = 1.999 * positive();
  if (random() % 2 == 0) {
    values[reg_demodulation_cos] = std::copysign(1.999, uniform(random));
    values[reg_demodulation_sin] = std::copysign(1.999, uniform(random));
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = floor_to(values[i], registers[i].format.fraction);
  return values;
}

// In steps and in batches by turns; a second chain without a listener only in batches.
void run(const InstrumentParameters& instrument, unsigned seed, std::set<std::string>& branches,
         std::uint64_t& status_seen) {
  constexpr int kOutputs = 120;
  std::mt19937_64 random(seed);
  const RegisterValues values = closing_registers(instrument, random);
  const std::string what = fmt::format("{} bit, seed {}", instrument.adc_bits, seed);
  Chain chain(Precision::quantised, instrument, values);
  Chain unheard(Precision::quantised, instrument, values);
  WholeNumbers expected(instrument, values);
  Recorder recorder;
  chain.set_taps(&recorder);
  Pieces pieces(instrument, seed);
  std::vector<ChainRecord> records;
  std::vector<ChainRecord> unheard_records;
  const Eigen::Index count = Eigen::Index{kOutputs} * ticks_per_output * instrument.decimation;
  for (Eigen::Index done = 0; done < count;) {
    const Eigen::Index size =
        std::min<Eigen::Index>(count - done, 1 + static_cast<Eigen::Index>(random() % 400));
    const bool single = random() % 2 == 0;
    Eigen::VectorXd x(size);
    Eigen::VectorXd y(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      std::tie(x[i], y[i]) = pieces.next();
      const auto raw =
          expected.sample(static_cast<std::int64_t>(x[i]), static_cast<std::int64_t>(y[i]), false);
      if (!single) continue;
      const DacWords words = chain.step(x[i], y[i], false, records);
      ASSERT_EQ(words.drive * 32768.0, static_cast<double>(raw[0])) << what;
      ASSERT_EQ(words.rebalance * 32768.0, static_cast<double>(raw[1])) << what;
      ASSERT_EQ(words.quadrature * 32768.0, static_cast<double>(raw[2])) << what;
    }
    if (!single) chain.samples(x, y, nullptr, records);
    unheard.samples(x, y, nullptr, unheard_records);
    done += size;
  }
  expect_equal(recorder, expected, what, status_seen);
  if (::testing::Test::HasFatalFailure()) return;
  expect_sums(recorder, records, what);
  ASSERT_EQ(records.size(), unheard_records.size());
  for (std::size_t m = 0; m < records.size(); ++m) {
    ASSERT_EQ(records[m].words, unheard_records[m].words) << what << ", output " << m;
  }
  branches.insert(expected.branches.begin(), expected.branches.end());
}

std::set<std::string> all_branches() {
  std::set<std::string> all = {"search to open, low",
                               "open to open",
                               "open to open, low",
                               "search to search",
                               "search to search, low",
                               "search to acquire",
                               "acquire to acquire",
                               "acquire to search, low",
                               "acquire to rise",
                               "rise to rise",
                               "rise to rise, low",
                               "rise to acquire",
                               "rise to run",
                               "rise to search, low",
                               "run to run",
                               "run to run, low",
                               "run to acquire",
                               "run to search, low",
                               "search: step",
                               "search: sweep starts again",
                               "hold-over: over",
                               "hold-over: none",
                               "amplitude: error clips",
                               "rebalance: error clips",
                               "amplitude: proportional"};
  for (const std::string loop : {"amplitude: ", "quadrature: ", "rebalance: "}) {
    for (const char* branch : {"off", "hold", "closed", "high, holds", "low, holds", "high, comes back",
                               "low, comes back", "integral cut above", "integral cut below",
                               "command cut above", "command cut below", "proportional part clips"}) {
      all.insert(loop + branch);
    }
  }
  return all;
}

TEST(ClosedLoopContract, EveryTapAndDacWordEqualsWholeNumbersInEveryBranch) {
  std::set<std::string> branches;
  std::uint64_t status_seen = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    run(seed % 2 == 0 ? InstrumentParameters::reference() : InstrumentParameters::wide(), seed, branches,
        status_seen);
    if (HasFatalFailure()) return;
  }
  const std::set<std::string> all = all_branches();
  for (const std::string& branch : all) EXPECT_TRUE(branches.contains(branch)) << "not taken: " << branch;
  for (const std::string& branch : branches) EXPECT_TRUE(all.contains(branch)) << "not expected: " << branch;
  for (const StatusBit bit : {status_drive_saturated, status_quadrature_saturated, status_rebalance_saturated,
                              status_searching, status_starting, status_holdover, status_unlocked}) {
    EXPECT_TRUE(status_seen >> bit & 1) << status_names[bit];
  }
}

}  // namespace
}  // namespace hemi::golden::testing

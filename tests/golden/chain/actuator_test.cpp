// SPDX-License-Identifier: Apache-2.0
// Properties of start-up, actuator loops and modulator that hold whatever the words are.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "tests/golden/chain/contract.hpp"

namespace hemi::golden::testing {
namespace {

using namespace config;
constexpr double kPi = std::numbers::pi;
constexpr double kDacStep = 1.0 / 32768.0;

// ---- modulator
// -----------------------------------------------------------------------------------------------------

TEST(ErrorFeedback, SumOfWordsIsTheSumOfTheValues) {
  std::mt19937_64 random(1);
  for (const double largest : {0.9, 1e-3, 3e-5, 1e-6}) {  // down to a thirtieth of a word
    ErrorFeedback dac(Precision::quantised);
    double difference = 0.0;
    double worst = 0.0;
    const double constant = largest * uniform(random);
    for (int n = 0; n < 100000; ++n) {
      const double value = round_to(n < 50000 ? constant : largest * uniform(random), dac_sum.fraction);
      const double word = dac(value);
      EXPECT_EQ(word, round_to(word, config::dac.fraction));
      difference += value - word;
      worst = std::max(worst, std::abs(difference));
    }
    EXPECT_LE(worst, kDacStep / 2.0);
    EXPECT_GT(worst, kDacStep / 8.0);  // something was rounded
  }
}

TEST(ErrorFeedback, ClippedWordGivesUpWhatItMisses) {
  ErrorFeedback dac(Precision::quantised);
  for (int n = 0; n < 10; ++n) EXPECT_EQ(dac(1.5), 1.0 - kDacStep);
  EXPECT_EQ(dac(0.25), 0.25);
  for (int n = 0; n < 10; ++n) EXPECT_EQ(dac(-1.5), -1.0);
  EXPECT_EQ(dac(0.25), 0.25);
}

TEST(ErrorFeedback, NoiseIsWhiteTimesItsDifference) {
  // Words of a drive that changes at random from tick to tick, less the force asked for: (1 - z^-1) e, e
  // uniform in one word. Periodograms of 4096 samples in 16 bands; a band has 128 lines of exponential
  // scatter in each of 200 blocks, 5 sigma = 5 / sqrt(128 * 200) = 3.1 %; the Hann window spreads a line over
  // its neighbours, whose powers are then not independent: two lines' worth each, 4.4 %.
  constexpr Eigen::Index kSize = 4096;
  constexpr int kBlocks = 200;
  constexpr Eigen::Index kBands = 16;
  const double increment = 4425.1234567 / 1e5;
  std::mt19937_64 random(2);
  Modulator modulator(Precision::quantised, {0.1, 2.5});
  Nco nco(Precision::quantised, round_to(increment, config::increment.fraction));
  Eigen::ArrayXd phase(20), cosine(20), sine(20), carrier(20), drive(20), rebalance(20);
  const Eigen::VectorXd window = Eigen::VectorXd::NullaryExpr(
      kSize, [](Eigen::Index n) { return 0.5 - 0.5 * std::cos(2.0 * kPi * static_cast<double>(n) / kSize); });
  Eigen::ArrayXd power = Eigen::ArrayXd::Zero(kSize / 2);
  double command_now = 0.0;
  double command_next = 0.0;
  Eigen::VectorXd error(kSize);
  Eigen::Index filled = 0;
  for (int blocks = 0; blocks < kBlocks;) {
    modulator.engage();
    command_now = command_next;
    command_next = round_to(0.6 + 0.01 * uniform(random), command.fraction);
    modulator.tick({command_next, 0.0, 0.0}, increment);
    nco.run(20, phase, cosine, sine);
    modulator.run(phase, carrier, drive, rebalance);
    for (Eigen::Index i = 0; i < 20 && blocks < kBlocks; ++i) {
      error[filled++] = drive[i] + command_now * carrier[i];
      if (filled < kSize) continue;
      filled = 0;
      ++blocks;
      Eigen::FFT<double> fft;
      Eigen::VectorXcd lines;
      fft.fwd(lines, Eigen::VectorXd(error.cwiseProduct(window)));
      power += lines.head(kSize / 2).array().abs2();
    }
  }
  power /= kBlocks * window.squaredNorm() * kDacStep * kDacStep / 12.0;
  double worst = 0.0;
  for (Eigen::Index band = 0; band < kBands; ++band) {
    const Eigen::Index width = kSize / 2 / kBands;
    double expected = 0.0;
    double measured = 0.0;
    for (Eigen::Index i = std::max<Eigen::Index>(band * width, 2); i < (band + 1) * width; ++i) {
      expected += std::norm(1.0 - std::polar(1.0, -2.0 * kPi * static_cast<double>(i) / kSize));
      measured += power[i];
    }
    worst = std::max(worst, std::abs(measured / expected - 1.0));
  }
  const double at_carrier = power.segment(static_cast<Eigen::Index>(increment * kSize) - 20, 40).mean();
  fmt::print("DAC noise in {} bands: within {:.2f} % of (1 - z^-1) white; around the carrier {:.2f} dB\n",
             kBands, 100.0 * worst, 10.0 * std::log10(at_carrier));
  EXPECT_LE(worst, 5.0 * std::sqrt(2.0 / (128.0 * kBlocks)));
}

// Taps of a run without signal: the nco stays at its start.
Recorder silence(Precision precision, const RegisterValues& values, Eigen::Index ticks) {
  Chain chain(precision, InstrumentParameters::reference(), values);
  Recorder recorder;
  chain.set_taps(&recorder);
  std::vector<ChainRecord> records;
  const Eigen::VectorXd zeros = Eigen::VectorXd::Zero(ticks * 20);
  chain.samples(zeros, zeros, nullptr, records);
  return recorder;
}

std::vector<double> values_of(const Recorder& recorder, TapIndex index) {
  std::vector<double> values;
  for (const auto& [i, value] : recorder.taps_) {
    if (i == index) values.push_back(value);
  }
  return values;
}

TEST(Modulator, CarrierLeadsTheNcoByTheDelay) {
  for (const double delay : {-7.0, 0.0, 2.0, 30.0}) {
    RegisterValues values = reference_values(InstrumentParameters::reference(), 4425.1234567);
    values[reg_modulation_delay] = delay;
    const Recorder recorder = silence(Precision::quantised, values, 100);
    const std::vector<double> sine = values_of(recorder, tap_sin);
    const std::vector<double> carrier = values_of(recorder, tap_carrier);
    // The increment loses up to 2^-31 a sample of delay, the offset is rounded to 2^-32 turn, so that the
    // angle of 24 bits may be the next one; the values are rounded to 2^-19 each.
    const double turns = std::abs(delay) * 0x1p-31 + 0x1p-33 + 0x1p-24;
    const double limit = 2.0 * kPi * turns + 0x1p-19;
    for (std::size_t n = 2 * 20; n < carrier.size() - 30;
         ++n) {  // the offset is in force from the third tick
      const auto ahead = static_cast<std::size_t>(static_cast<double>(n) + delay);
      EXPECT_NEAR(carrier[n], sine[ahead], limit) << delay << ", " << n;
    }
    for (std::size_t n = 0; n < 2 * 20; ++n) EXPECT_EQ(carrier[n], sine[n]);
  }
}

TEST(Modulator, IdealDriveIsInPhaseWithTheVelocity) {
  // Search drives with the limit; -sin of the phase, led by phase and delay, unrounded.
  RegisterValues values = reference_values(InstrumentParameters::reference(), 4425.1234567);
  values[reg_control] = 1.0;
  values[reg_search_amplitude] = 0.01;
  values[reg_search_ticks] = 1e6;
  values[reg_drive_limit] = 0.7;
  values[reg_modulation_phase] = 0.123;
  values[reg_modulation_delay] = 2.7;
  const Recorder recorder = silence(Precision::ideal, values, 100);
  const std::vector<double> drive = values_of(recorder, tap_dac_drive);
  const std::vector<double> rebalance = values_of(recorder, tap_dac_rebalance);
  const double scale = table_scale / 1048576.0;
  for (std::size_t n = 0; n < drive.size(); ++n) {
    const double turns = modulo(values[reg_nco_start] * (static_cast<double>(n) + 2.7) + 0.123, 1.0);
    const double expected = n < 2 * 20 ? 0.0 : -0.7 * scale * std::sin(2.0 * kPi * turns);
    EXPECT_NEAR(drive[n], expected, 1e-12) << n;  // phases of up to 16 turns: 2^-49 turn each, 2000 times
    EXPECT_EQ(rebalance[n], 0.0);
  }
}

TEST(Modulator, NothingMovesInOpenLoop) {
  RegisterValues values = reference_values(InstrumentParameters::reference(), 4425.0);
  values[reg_drive_limit] = values[reg_drive_start] = values[reg_quadrature_start] = 0.5;
  const Recorder recorder = silence(Precision::quantised, values, 50);
  for (const TapIndex tap : {tap_dac_drive, tap_dac_rebalance, tap_dac_quadrature, tap_drive, tap_state}) {
    for (const double value : values_of(recorder, tap)) ASSERT_EQ(value, 0.0);
  }
}

// ---- start_up
// -----------------------------------------------------------------------------------------------------

class StartUpTable : public ::testing::Test {
 protected:
  // Threshold, search and closing amplitude 0.1, 0.2, 0.3.
  StartUp start_up_{Precision::quantised, {true, 0.1, 0.2, 0.3, 3.0, 0.25, 0.5, 4.0}};
  void expect(double amplitude, bool locked, LoopState state, bool restart = false) {
    start_up_.tick(amplitude, locked);
    EXPECT_EQ(start_up_.state(), state);
    EXPECT_EQ(start_up_.restart(), restart);
    EXPECT_EQ(start_up_.searching(), state == state_search);
    EXPECT_EQ(start_up_.starting(), state != state_run);
  }
  void reach_run() {
    expect(0.2, false, state_acquire);
    expect(0.2, true, state_rise);
    expect(0.3, true, state_run);
  }
};

TEST_F(StartUpTable, SearchSweepsUpAndStartsAgainBelow) {
  for (const double offset : {0.25, 0.5, -0.5, -0.25, 0.0, 0.25}) {
    expect(0.0, false, state_search);
    expect(0.15, true, state_search);  // between threshold and search amplitude nothing is found yet
    expect(0.0, false, state_search, true);
    EXPECT_EQ(start_up_.search_offset(), offset);
  }
}

TEST_F(StartUpTable, TakesOneLineATick) {
  expect(1.0, true, state_acquire);
  expect(1.0, true, state_rise);
  expect(1.0, true, state_run);
}

TEST_F(StartUpTable, AcquireWaitsForLockAndGoesBackWithoutSignal) {
  expect(0.2, false, state_acquire);
  expect(0.15, false, state_acquire);
  expect(0.05, true, state_search);
  reach_run();
}

TEST_F(StartUpTable, RunStaysWhereAmplitudeFallsButStaysAboveTheThreshold) {
  reach_run();
  expect(0.1, true, state_run);
  expect(0.1, false, state_acquire);
}

TEST_F(StartUpTable, HoldsOverUntilTheTimeIsUp) {
  reach_run();
  for (int i = 0; i < 3; ++i) expect(0.05, true, state_run);
  expect(0.2, true, state_run);  // the count starts anew
  for (int i = 0; i < 3; ++i) expect(0.05, false, state_run);
  expect(0.05, false, state_search, true);
  EXPECT_EQ(start_up_.search_offset(), 0.0);
}

TEST_F(StartUpTable, HoldsOverInRiseAsWell) {
  expect(0.2, false, state_acquire);
  expect(0.2, true, state_rise);
  for (int i = 0; i < 3; ++i) expect(0.05, true, state_rise);
  expect(0.05, true, state_search, true);
}

// ---- actuator loops
// -----------------------------------------------------------------------------------------------

class Controller : public ::testing::TestWithParam<Precision> {
 protected:
  // All of these numbers are words.
  ActuatorLoop loop_{GetParam(), {0.25, 0.0078125, 0.125, 0.5}};
};

TEST_P(Controller, IntegralStopsAtTheLimitAndComesBackAtOnce) {
  loop_.tick(LoopMode::off, 0.75);
  EXPECT_EQ(loop_.integral(), 0.125);
  EXPECT_EQ(loop_.command(), 0.0);
  // Error 3/4: Kp e = 3/16, Ki e = 3/512. The integral climbs as long as with its own step it stays within
  // 1/2 - 3/16 = 5/16, to 1/8 + 32 3/512.
  for (int k = 1; k <= 1000; ++k) {
    loop_.tick(LoopMode::closed, 0.75);
    const double integral = 0.125 + std::min(k, 32) * 3.0 / 512.0;
    EXPECT_EQ(loop_.integral(), integral);
    EXPECT_EQ(loop_.command(), integral + 0.1875);
    EXPECT_EQ(loop_.saturated(), k > 32);
  }
  EXPECT_EQ(loop_.command(), 0.5);
  // However long it was at the limit, the opposite error turns it the tick it comes.
  loop_.tick(LoopMode::closed, -0.75);
  EXPECT_EQ(loop_.integral(), 0.3125 - 3.0 / 512.0);
  EXPECT_EQ(loop_.command(), 0.3125 - 3.0 / 512.0 - 0.1875);
  EXPECT_FALSE(loop_.saturated());
}

TEST_P(Controller, LimitsBothWays) {
  for (const double sign : {1.0, -1.0}) {
    loop_.tick(LoopMode::off, 0.0);
    for (int k = 0; k < 10000; ++k) {
      // Alternating errors with a mean: outwards beyond the limit, back within.
      loop_.tick(LoopMode::closed, sign * (k % 2 == 0 ? 0.9375 : -0.5));
      ASSERT_LE(std::abs(loop_.integral()), 0.5);
      ASSERT_LE(std::abs(loop_.command()), 0.5);
    }
    EXPECT_GT(sign * loop_.integral(), 0.25);
  }
}

TEST_P(Controller, HoldAndProportionalLeaveTheIntegral) {
  loop_.tick(LoopMode::off, 0.0);
  loop_.tick(LoopMode::proportional, 0.5);
  EXPECT_EQ(loop_.integral(), 0.125);
  EXPECT_EQ(loop_.command(), 0.25);
  loop_.tick(LoopMode::hold, 0.5);
  EXPECT_EQ(loop_.integral(), 0.125);
  EXPECT_EQ(loop_.command(), 0.125);
}

TEST_P(Controller, IsAProportionalIntegralControllerWithinItsLimits) {
  std::mt19937_64 random(3);
  double sum = 0.125;
  loop_.tick(LoopMode::off, 0.0);
  for (int k = 0; k < 1000; ++k) {
    const double error = round_to(0.4 * uniform(random), baseband.fraction);
    loop_.tick(LoopMode::closed, error);
    sum += 0.0078125 * error;
    // Steps rounded to 2^-40 each, the command floored to 2^-30.
    const double limit = GetParam() == Precision::ideal ? 1e-15 * (k + 1) : (k + 2) * 0x1p-41 + 0x1p-30;
    ASSERT_NEAR(loop_.command(), sum + 0.25 * error, limit);
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Controller, ::testing::Values(Precision::ideal, Precision::quantised),
                         [](const auto& suite) {
                           return suite.param == Precision::ideal ? "Ideal" : "Quantised";
                         });

}  // namespace
}  // namespace hemi::golden::testing

// SPDX-License-Identifier: Apache-2.0
// The stages on a few concealed captures (all of them nightly), and on what each test must tell apart.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/cli/stage/matrix.hpp"

namespace hemi::tests {
namespace {

using diagnosis::Curve;
using diagnosis::Stage;

TEST(Stage, OneCaptureOfEachClass) {
  Matrix matrix;
  for (int f = 0; f < fault_count; ++f)
    matrix.run(static_cast<Fault>(f), 0.6, 700 + static_cast<std::uint64_t>(f), 1.0);
  matrix.print();
  EXPECT_EQ(matrix.score(false).right, fault_count);
}

// x = A cos + r(cos) in white noise, through the harmonics to the curve.
Curve curve_of(const std::function<double(double)>& r) {
  constexpr double amplitude = 26000.0, hz = 4431.7, rate_hz = 1e5;
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.6);
  Eigen::VectorXd x(50000);
  for (Eigen::Index n = 0; n < x.size(); ++n) {
    const double u = std::cos(2.0 * std::numbers::pi * std::fmod(hz / rate_hz * static_cast<double>(n), 1.0));
    x[n] = std::round(amplitude * u + r(u) + noise(random));
  }
  return diagnosis::choose_curve(diagnosis::fit_tones(x, rate_hz, 4000).harmonics, 0.002).chosen.curve;
}

TEST(Stage, CurvesAreToldApart) {
  EXPECT_EQ(curve_of([](double) { return 0.0; }), Curve::none);
  EXPECT_EQ(curve_of([](double) { return 3.0; }), Curve::offset);
  EXPECT_EQ(curve_of([](double u) { return 40.0 * u * u + 5.0 * u * u * u; }), Curve::smooth);
  EXPECT_EQ(curve_of([](double u) { return 2.0 * (u * u / 3.0 - 2.0 / 3.0); }), Curve::stiffness);
  EXPECT_EQ(curve_of([](double u) { return u > 0.97 ? -26000.0 * (u - 0.97) : 0.0; }), Curve::flat_top);
  EXPECT_EQ(curve_of([](double u) { return std::fmod(u + 1.0, 0.125) * 16.0 - 1.0; }), Curve::codes);
}

TEST(Stage, HarmonicsHaveTheSpreadThatTheoryGivesThem) {
  // chi^2 of the harmonics of pure tones in white noise: mean `freedom`, deviation sqrt(2 freedom / runs).
  constexpr int runs = 24;
  double sum = 0.0;
  int freedom = 0;
  std::mt19937_64 random(77);
  std::normal_distribution<double> noise(0.0, 0.7);
  for (int run = 0; run < runs; ++run) {
    Eigen::VectorXd x(16000);
    const double hz = 4400.0 + 3.7 * run;
    for (Eigen::Index n = 0; n < x.size(); ++n)
      x[n] = std::round(
          26000.0 * std::cos(2.0 * std::numbers::pi * std::fmod(hz * 1e-5 * static_cast<double>(n), 1.0)) +
          noise(random));
    const auto choice = diagnosis::choose_curve(diagnosis::fit_tones(x, 1e5, 4000).harmonics, 0.0);
    sum += choice.chi2 / choice.freedom;
    freedom = choice.freedom;
  }
  EXPECT_NEAR(sum / runs, 1.0, 4.0 * std::sqrt(2.0 / freedom / runs));
}

TEST(Stage, NamesTheRegisterThatExplainsEveryWord) {
  Concealed good = make_concealed(Fault::none, 0.0, 11, 0.6);
  // The recorded words are those of a core with one other gain on the same samples.
  auto wrong = good.shown.registers;
  wrong[config::reg_bias_f] *= 1.07;
  const auto replay = make_words(good.shown, wrong);
  good.shown.records = replay;
  const auto d = diagnose(good.shown);
  ASSERT_EQ(d.stage, Stage::core);
  ASSERT_TRUE(d.core && d.core->first_record);
  EXPECT_EQ(d.core->block, "derivative or bias_model");
  bool named = false;
  for (const auto& r : d.core->registers) named = named || r.index == config::reg_bias_f;
  EXPECT_TRUE(named);
}

TEST(Stage, WithoutTelemetryTheCoreIsNotJudged) {
  Concealed good = make_concealed(Fault::none, 0.0, 12, 0.6);
  good.shown.records.clear();
  const auto d = diagnose(good.shown);
  EXPECT_EQ(d.stage, Stage::none);
  EXPECT_FALSE(d.core.has_value());
  EXPECT_FALSE(d.notes.empty());
}

}  // namespace
}  // namespace hemi::tests

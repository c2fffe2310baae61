// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/events.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/golden/diagnosis/telemetry_writer.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;

TEST(Events, FindsRepeatsAndSlipsAndNothingElse) {
  const NominalModel model = tests::nominal();
  Telemetry t = tests::telemetry({.seed = 3});
  EXPECT_TRUE(find_events(t, simulate(t, model, 0.0)).repeats.empty());
  EXPECT_TRUE(find_events(t, simulate(t, model, 0.0)).slips.empty());
  for (const Index row : {500, 501, 9000})
    for (auto& output : t.outputs) output[row] = output[row - 1];
  t.outputs[place(Output::frequency)][4000] += 1.0;
  t.outputs[place(Output::frequency)][7000] -= 0.6;
  t.outputs[place(Output::frequency)][7001] -= 0.4;
  t.outputs[place(Output::frequency)][8000] += 0.5;  // no whole turn
  const Events events = find_events(t, simulate(t, model, 0.0));
  EXPECT_EQ(events.repeats, (std::vector<Index>{500, 501, 9000}));
  EXPECT_EQ(events.slips, (std::vector<Index>{4000, 7000}));
  const Telemetry clean = without_events(t, events);
  EXPECT_TRUE(std::isnan(clean[Output::rate][9000]));
  EXPECT_TRUE(std::isnan(clean[Output::frequency][7001]));
  EXPECT_FALSE(std::isnan(clean[Output::rate][7000]));
}

TEST(Events, TellsAStandingLineFromOneThatMovesWithTheResonator) {
  const NominalModel model = tests::nominal();
  const Telemetry t = tests::telemetry({.seed = 4});
  const Simulation s = simulate(t, model, 0.0);
  const Eigen::VectorXd noise = t[Output::rate] - s.nominal[Output::rate];
  EXPECT_FALSE(find_line(t, s, Output::rate, noise));
  Eigen::VectorXd standing = noise, moving = noise;
  double turns = 0.0;
  for (Index i = 0; i < noise.size(); ++i) {
    standing[i] += 0.1 * std::sin(2.0 * std::numbers::pi * 0.137 * static_cast<double>(i));
    moving[i] += 0.1 * std::sin(2.0 * std::numbers::pi * std::fmod(turns, 1.0));
    turns += 2.0 * t[Output::frequency][i] * t.step_s;
  }
  const auto still = find_line(t, s, Output::rate, standing);
  ASSERT_TRUE(still);
  EXPECT_EQ(still->harmonic, 0);
  EXPECT_NEAR(still->frequency_hz, 0.137, 1.0 / static_cast<double>(noise.size()));
  const auto with = find_line(t, s, Output::rate, moving);
  ASSERT_TRUE(with);
  EXPECT_EQ(with->harmonic, 2);
  // A line between two bins loses up to 4 dB; noise beside it moves it by five of its deviations at most.
  EXPECT_GT(with->amplitude, 0.1 * 0.63 - 5.0 * with->amplitude_deviation);
  EXPECT_LT(with->amplitude, 0.1 + 5.0 * with->amplitude_deviation);
}

}  // namespace
}  // namespace hemi::diagnosis

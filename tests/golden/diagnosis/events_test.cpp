// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/events.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/golden/diagnosis/telemetry_writer.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;

TEST(Events, FindsRepeatsAndSlipsAndNothingElse) {
  const NominalModel model = tests::nominal();
  Telemetry t = tests::telemetry({.seed = 3});
  EXPECT_TRUE(find_events(t, simulate(t, model)).repeats.empty());
  EXPECT_TRUE(find_events(t, simulate(t, model)).slips.empty());
  for (const Index row : {500, 501, 9000})
    for (auto& output : t.outputs) output[row] = output[row - 1];
  t.outputs[place(Output::frequency)][4000] += 1.0;
  t.outputs[place(Output::frequency)][7000] -= 0.6;
  t.outputs[place(Output::frequency)][7001] -= 0.4;
  t.outputs[place(Output::frequency)][8000] += 0.5;  // no whole turn
  const Events events = find_events(t, simulate(t, model));
  EXPECT_EQ(events.repeats, (std::vector<Index>{500, 501, 9000}));
  EXPECT_EQ(events.slips, (std::vector<Index>{4000, 7000}));
  const Telemetry clean = without_events(t, events);
  EXPECT_TRUE(std::isnan(clean[Output::rate][9000]));
  EXPECT_TRUE(std::isnan(clean[Output::frequency][7001]));
  EXPECT_FALSE(std::isnan(clean[Output::rate][7000]));
}

}  // namespace
}  // namespace hemi::diagnosis

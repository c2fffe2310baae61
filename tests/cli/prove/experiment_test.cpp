// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/experiment.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cli/prove/write.hpp"
#include "golden/concealed/draw.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::prove {
namespace {

class Experiment : public recording::testing::ScratchTest {};

TEST_F(Experiment, IsFoundInTheAnswer) {
  std::ofstream(path("diagnosis.json")) << R"({"format": "hemi-diagnosis/1", "verdict": "ambiguous",
    "alternatives": [{"id": "a"}, {"id": "b", "separating_experiment": "two ramps (`experiment.toml`)."}]})";
  EXPECT_EQ(proposed_scenario(path(".")), "");  // the file is not there
  std::ofstream(path("experiment.toml")) << "[scenario]\n";
  EXPECT_EQ(std::filesystem::path(proposed_scenario(path("."))).filename(), "experiment.toml");
}

TEST_F(Experiment, GivesTheSameInstrumentAndEffectAnotherRun) {
  // Inputs of a recording come back, and the effect with them: the frequency differs from the nominal one
  // by the same relative shift at the steps of the amplitude.
  concealed::Random random(12);
  const auto stand = concealed::random_stand(random, "cycle", concealed::kSteps);
  const auto drawn = concealed::draw_effect(random, stand, concealed::detectability(stand),
                                            concealed::kind("duffing"), {200.0, 800.0});
  ASSERT_TRUE(drawn);
  concealed::Case drawn_case;
  drawn_case.unit = stand.unit;
  drawn_case.stated = stand.unit.model;
  drawn_case.in = stand.in;
  drawn_case.effects = {drawn->truth};
  drawn_case.again = {{drawn->truth.id, drawn->before, drawn->truth.strength}};
  const auto first = concealed::repeat_case(drawn_case, stand.in);
  write_concealed(first, path("."), "one");
  const auto inputs = inputs_of(path("one.csv"), first.unit);
  ASSERT_TRUE(inputs);
  EXPECT_LT((inputs->case_degc - first.in.case_degc.head(inputs->case_degc.size())).abs().maxCoeff(), 0.1);
  EXPECT_LT((inputs->amplitude - first.in.amplitude.head(inputs->amplitude.size())).abs().maxCoeff(), 1e-3);
  const auto again = concealed::repeat_case(drawn_case, *inputs);
  const auto nominal = concealed::simulate(first.unit.model, *inputs, first.unit.nuisance.start_offset_degc);
  const concealed::Series relative = again.written.frequency_hz / nominal.frequency_hz - 1.0;
  const concealed::Series expected = first.effects[0].strength * (inputs->amplitude.square() - 1.0);
  // Per-sample noise below 1e-4 Hz of 4425 Hz; the mean over the run is taken to far below the shift.
  EXPECT_LT(std::abs((relative - expected).mean()), 0.05 * expected.abs().maxCoeff());
  EXPECT_GT(((relative - relative.mean()) * (expected - expected.mean())).mean(), 0.0);
}

TEST_F(Experiment, OfAFewMinutesIsNone) {
  std::ofstream file(path("short.csv"));
  file << "time_s,case_temp_degc,frequency_hz\n";
  for (int i = 0; i < 300; ++i) file << i << ",20,4432\n";
  file.close();
  EXPECT_FALSE(inputs_of(path("short.csv"), {}));
}

}  // namespace
}  // namespace hemi::prove

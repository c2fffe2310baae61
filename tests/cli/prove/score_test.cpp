// SPDX-License-Identifier: Apache-2.0
// Hand-made diagnoses against hand-made truths.
#include "cli/prove/score.hpp"

#include <gtest/gtest.h>

#include "cli/prove/report.hpp"

namespace hemi::prove {
namespace {

Truth truth(const std::string& cls, const std::vector<std::string>& ids = {}) {
  Truth made;
  made.name = "r";
  made.cls = cls;
  for (const auto& id : ids) made.effects.push_back({id, "rate_dph", 60.0, {{"gain", 2.0}}});
  made.noise_rms = {{"rate_dph", 1.0}};
  if (!ids.empty()) made.located = {{"rate_dph", {{0.0, 1000.0}}, {}}};
  return made;
}

Answer says(const std::string& verdict, const std::vector<std::string>& ids = {},
            const std::vector<std::string>& alternatives = {}) {
  Answer made;
  made.verdict = verdict;
  for (const auto& id : ids) made.effects.push_back({id, 0.95, {{"gain", {2.1, 1.8, 2.4}}}});
  made.alternatives = alternatives;
  made.heldout = {{"rate_dph", {2.0, 1.1, 1.0}}};
  made.located = {{"rate_dph", {{0.0, 800.0}}, {}}};
  return made;
}

Row row(const Score& score, const std::string& key) {
  for (const Row& one : score.rows())
    if (one.key == key) return one;
  ADD_FAILURE() << "no row " << key;
  return {};
}

bool is_right(const Truth& t, const Answer& a) {
  std::string why;
  return right(t, a, why);
}

TEST(Score, CountsNamesWhereNothingIsLeftOut) {
  Score score;
  for (int i = 0; i < 98; ++i) score.add(truth("null"), says("consistent"));
  score.add(truth("null"), says("named", {"duffing"}));
  score.add(truth("null"), says("ambiguous", {}, {"duffing", "self_heating"}));
  const Row named = row(score, "null_named");
  EXPECT_DOUBLE_EQ(named.value, 0.02);
  EXPECT_FALSE(named.held);
  EXPECT_EQ(score.failures().size(), 2u);
  EXPECT_EQ(score.confusion().at("null").at("consistent"), 98);
}

TEST(Score, NamesOneAfterAnother) {
  const Truth one = truth("single_strong", {"duffing"});
  EXPECT_TRUE(right_first(one, says("named", {"duffing", "gas_leak"})));
  EXPECT_FALSE(right_first(one, says("named", {"gas_leak", "duffing"})));
  EXPECT_FALSE(is_right(one, says("named", {"duffing", "gas_leak"})));  // a wrong name beside
  EXPECT_FALSE(right_first(one, says("ambiguous", {}, {"duffing", "gas_leak"})));
  Truth twin = one;
  twin.set = {"duffing", "gas_leak"};
  EXPECT_TRUE(right_first(twin, says("ambiguous", {}, {"duffing", "gas_leak"})));
  EXPECT_FALSE(right_first(twin, says("ambiguous", {}, {"gas_leak", "self_heating"})));
}

TEST(Score, AnExperimentResolvesWhereItNamesTheEffectInQuestion) {
  const Truth one = truth("poor", {"gas_leak", "forcer_misalignment"});
  EXPECT_TRUE(resolves(one, says("named", {"gas_leak", "forcer_misalignment"})));
  EXPECT_TRUE(resolves(one, says("named", {"forcer_misalignment"})));
  EXPECT_FALSE(resolves(one, says("named", {"gas_leak"})));  // which was no question
  EXPECT_FALSE(resolves(one, says("named", {"forcer_misalignment", "duffing"})));
  EXPECT_FALSE(resolves(one, says("ambiguous", {}, {"forcer_misalignment", "damping_anisotropy"})));
  EXPECT_FALSE(resolves(one, says("unknown", {"unknown"})));
  // One clock leaves the two ageings together; a third must be gone.
  const Truth aged = truth("poor", {"frequency_ageing"});
  EXPECT_TRUE(resolves(aged, says("ambiguous", {}, {"oscillator_ageing", "frequency_ageing"})));
  EXPECT_FALSE(
      resolves(aged, says("ambiguous", {}, {"oscillator_ageing", "frequency_ageing", "self_heating"})));
  EXPECT_FALSE(resolves(aged, says("ambiguous", {}, {"oscillator_ageing", "self_heating"})));
  Score score;
  score.add_experiment(one, says("named", {"forcer_misalignment"}));
  score.add_experiment(one, says("named", {"gas_leak"}));
  EXPECT_DOUBLE_EQ(row(score, "experiment").value, 0.5);
  EXPECT_EQ(score.failures().size(), 1u);
}

TEST(Score, JudgesEachClassByItsOwnRule) {
  EXPECT_TRUE(is_right(truth("weak", {"duffing"}), says("consistent")));
  EXPECT_FALSE(is_right(truth("weak", {"duffing"}), says("named", {"duffing"})));
  EXPECT_TRUE(is_right(truth("unknown", {"u_etalon"}), says("unknown", {"unknown"})));
  EXPECT_FALSE(is_right(truth("unknown", {"u_etalon"}), says("consistent")));
  EXPECT_TRUE(is_right(truth("pair", {"a", "b"}), says("named", {"b", "a"})));
  EXPECT_TRUE(is_right(truth("pair", {"a", "b"}), says("ambiguous", {"a"}, {"b", "c"})));
  EXPECT_FALSE(is_right(truth("pair", {"a", "b"}), says("named", {"a"})));
  EXPECT_TRUE(is_right(truth("poor", {"a"}), says("ambiguous", {}, {"a", "b"})));
  EXPECT_FALSE(is_right(truth("poor", {"a"}), says("named", {"a"})));
  EXPECT_TRUE(is_right(truth("params"), says("recalibrate")));
  EXPECT_FALSE(is_right(truth("params"), says("unknown")));
  Truth dropped = truth("confounder");
  dropped.tolerated = {"sample_loss"};
  EXPECT_TRUE(is_right(dropped, says("named", {"sample_loss"})));
  EXPECT_FALSE(is_right(dropped, says("named", {"cycle_slip"})));
  Answer crashed;
  crashed.failure = "ended by signal 11";
  EXPECT_FALSE(is_right(truth("null"), crashed));
}

TEST(Score, MeasuresWhatTheNumbersPromise) {
  Score score;
  score.add(truth("single_strong", {"duffing"}), says("named", {"duffing"}));
  EXPECT_DOUBLE_EQ(row(score, "coverage").value, 1.0);
  EXPECT_NEAR(row(score, "parameter_error").value, 0.05, 1e-12);
  EXPECT_NEAR(row(score, "closed").value, (4.0 - 1.21) / (4.0 - 1.0), 1e-12);
  EXPECT_NEAR(row(score, "overlap").value, 0.8, 1e-12);
  EXPECT_NEAR(row(score, "on_truth").value, 0.95, 1e-12);
  EXPECT_NEAR(row(score, "calibration").value, 0.05, 1e-12);
  Truth other_sign = truth("single_strong", {"electrostatic_softening"});
  other_sign.effects[0].parameters = {{"relative_shift", 2.0}};
  Answer negative = says("named", {"electrostatic_softening"});
  negative.effects[0].parameters = {{"relative_shift", {-2.0, -2.2, -1.9}}};
  score.add(other_sign, negative);
  EXPECT_EQ(row(score, "coverage").trials, 2);
  EXPECT_DOUBLE_EQ(row(score, "coverage").value, 1.0);
}

TEST(Score, LooksForALineInItsBand) {
  Truth line = truth("single_strong", {"interference"});
  line.effects[0].parameters = {{"frequency", 0.1}};
  Answer answer = says("named", {"interference"});
  answer.located[0].band_hz = {0.095, 0.105};
  Score score;
  score.add(line, answer);
  EXPECT_DOUBLE_EQ(row(score, "overlap").value, 1.0);
  answer.located[0].band_hz = {0.001, 0.5};  // everywhere is no place
  score.add(line, answer);
  EXPECT_DOUBLE_EQ(row(score, "overlap").value, 0.5);
}

TEST(Score, CountsWrongNamesOverAllClasses) {
  Score score;
  score.add(truth("pair", {"a", "b"}), says("named", {"a", "b", "c"}));
  score.add(truth("weak", {"a"}), says("named", {"a"}));
  const Row wrong = row(score, "wrong_names");
  EXPECT_EQ(wrong.trials, 4);
  EXPECT_DOUBLE_EQ(wrong.value, 0.25);
}

TEST(Report, HoldsOnlyWhereEveryRowHolds) {
  Score good, bad;
  good.add(truth("null"), says("consistent"));
  bad.add(truth("null"), says("named", {"duffing"}));
  Report report;
  report.own = &good;
  EXPECT_TRUE(all_held(report));
  report.rivals["stepwise"] = bad;
  EXPECT_TRUE(all_held(report));
  const std::string text = to_markdown(report);
  EXPECT_NE(text.find("stepwise"), std::string::npos);
  EXPECT_NE(text.find("Failures: 0"), std::string::npos);
  report.own = &bad;
  EXPECT_FALSE(all_held(report));
  EXPECT_EQ(to_json(report)["failures"].size(), 1u);
  EXPECT_EQ(to_json(report)["confusion"]["null"]["duffing"], 1);
}

}  // namespace
}  // namespace hemi::prove

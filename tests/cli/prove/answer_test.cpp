// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/answer.hpp"

#include <gtest/gtest.h>

#include "cli/prove/write.hpp"

namespace hemi::prove {
namespace {

using recording::Json;

Json document() {
  return Json::parse(R"({"format": "hemi-diagnosis/1", "verdict": "ambiguous",
    "located": [{"channel": "rate_dph", "time_s": [[0, 100], [200, 300]], "band_hz": [0.01, 0.02]}],
    "effects": [{"id": "gas_leak", "probability": 0.9,
                 "parameters": {"rate": {"value": 2e-4, "unit": "1/h", "ci95": [1e-4, 3e-4]}}},
                {"id": "duffing", "probability": 0.4}],
    "alternatives": [{"id": "duffing"}, {"id": "self_heating"}],
    "improvement": {"drive_v": {"heldout": {"before_rms": 3.0, "after_rms": 1.1, "floor_rms": 1.0}}}})");
}

TEST(Answer, IsReadAsTheFormatSays) {
  const Answer answer = parse_answer(document());
  EXPECT_EQ(answer.verdict, "ambiguous");
  EXPECT_EQ(answer.names(), std::vector<std::string>{"gas_leak"});  // duffing is one of the candidates
  EXPECT_EQ(answer.candidates(), (std::vector<std::string>{"duffing", "self_heating"}));
  EXPECT_DOUBLE_EQ(*answer.find("gas_leak")->probability, 0.9);
  EXPECT_DOUBLE_EQ(answer.find("gas_leak")->parameters.at("rate").high, 3e-4);
  EXPECT_EQ(answer.located.at(0).time_s.size(), 2u);
  EXPECT_DOUBLE_EQ(answer.located.at(0).band_hz->second, 0.02);
  EXPECT_DOUBLE_EQ(answer.heldout.at("drive_v").after_rms, 1.1);
}

TEST(Answer, UnknownIsNoName) {
  Json json = document();
  json["verdict"] = "unknown";
  json["effects"] = Json::parse(R"([{"id": "unknown"}])");
  const Answer answer = parse_answer(json);
  EXPECT_TRUE(answer.names().empty());
  EXPECT_TRUE(answer.candidates().empty());
  EXPECT_FALSE(answer.claims());
}

TEST(Answer, RefusesOtherDocuments) {
  Json json = document();
  json["verdict"] = "certainly";
  EXPECT_THROW(parse_answer(json), std::runtime_error);
  EXPECT_THROW(parse_answer(Json::parse("[1]")), std::runtime_error);
  json = document();
  json["alternatives"][0].erase("id");
  EXPECT_THROW(parse_answer(json), std::runtime_error);
}

TEST(Truth, ComesBackFromItsFile) {
  const auto hidden = concealed::make_case("pair", 9, 2);
  const Truth truth = parse_truth(truth_json(hidden, "some"));
  EXPECT_EQ(truth.name, "some");
  EXPECT_EQ(truth.cls, "pair");
  EXPECT_EQ(truth.label(), "pair");
  ASSERT_EQ(truth.effects.size(), 2u);
  EXPECT_TRUE(truth.holds(hidden.effects[0].id));
  EXPECT_DOUBLE_EQ(truth.dprime, hidden.dprime);
  ASSERT_FALSE(truth.located.empty());
  EXPECT_EQ(truth.noise_rms.size(), 4u);
}

}  // namespace
}  // namespace hemi::prove

// SPDX-License-Identifier: Apache-2.0
// The catalogue itself: completeness, descriptions, refusals.
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/golden/physics/effects_support.hpp"

namespace hemi::physics {
namespace {

const std::set<std::string> kIds = {"thermal_second_time_constant",
                                    "thermal_gradient_bias",
                                    "thermal_hysteresis",
                                    "frequency_polynomial_order",
                                    "frequency_ageing",
                                    "oscillator_temperature",
                                    "oscillator_ageing",
                                    "duffing",
                                    "quadratic_stiffness",
                                    "damping_nonlinearity",
                                    "electrostatic_softening",
                                    "self_heating",
                                    "gas_leak",
                                    "damping_temperature",
                                    "damping_anisotropy",
                                    "forcer_misalignment",
                                    "frequency_split",
                                    "demodulation_phase",
                                    "pickoff_gain",
                                    "pickoff_nonlinearity",
                                    "drive_feedthrough",
                                    "adc_saturation",
                                    "adc_nonlinearity",
                                    "adc_offset",
                                    "interference",
                                    "aliased_carrier",
                                    "pll_lag",
                                    "cycle_slip",
                                    "scale_factor_temperature",
                                    "scale_factor_nonlinearity",
                                    "earth_rate",
                                    "g_sensitivity",
                                    "rate_flicker",
                                    "rate_random_walk",
                                    "sample_loss",
                                    "time_shift"};

/// Names and units by which a diagnosis is scored.
struct ScoredParameter {
  std::string id;
  std::string name;
  std::string unit;
};
const std::vector<ScoredParameter> kScored = {{"thermal_second_time_constant", "second_time_constant", "s"},
                                              {"thermal_gradient_bias", "gain", "deg/h/degC"},
                                              {"thermal_gradient_bias", "node_time_constant", "s"},
                                              {"thermal_hysteresis", "loop_height", "deg/h"},
                                              {"frequency_polynomial_order", "a4", "Hz/degC^4"},
                                              {"frequency_ageing", "total", "Hz"},
                                              {"oscillator_temperature", "ppm_span", "ppm"},
                                              {"oscillator_ageing", "rate", "ppm/day"},
                                              {"duffing", "relative_shift", "1"},
                                              {"duffing", "k3", "1/(V^2 s^2)"},
                                              {"quadratic_stiffness", "k2", "1/(V s^2)"},
                                              {"electrostatic_softening", "relative_shift", "1"},
                                              {"self_heating", "rise", "degC"},
                                              {"self_heating", "time_constant", "s"},
                                              {"gas_leak", "rate", "1/h"},
                                              {"damping_temperature", "peak", "1"},
                                              {"damping_nonlinearity", "relative", "1"},
                                              {"demodulation_phase", "gain", "deg/h/V"},
                                              {"pickoff_gain", "per_degc", "1/degC"},
                                              {"forcer_misalignment", "gain", "deg/h/V"},
                                              {"damping_anisotropy", "gain", "deg/h/V"},
                                              {"frequency_split", "span", "V"},
                                              {"scale_factor_temperature", "per_degc", "1/degC"},
                                              {"scale_factor_nonlinearity", "cubic", "deg/h"},
                                              {"g_sensitivity", "per_g", "deg/h/g"},
                                              {"interference", "frequency", "Hz"},
                                              {"aliased_carrier", "frequency", "Hz"},
                                              {"cycle_slip", "count", "1"},
                                              {"sample_loss", "count", "1"},
                                              {"time_shift", "delay", "s"},
                                              {"rate_random_walk", "density", "deg/h/sqrt(s)"},
                                              {"rate_flicker", "density", "deg/h"}};

std::string refusal(const std::vector<ActiveEffect>& effects) {
  try {
    World world(Instrument{}, effects, Environment{}, 0);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_mentions(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
}

TEST(Catalogue, HasEveryEffectOnce) {
  std::set<std::string> registered;
  for (const auto& [id, entry] : catalogue()) {
    registered.insert(id);
    EXPECT_EQ(entry.description.id, id);
  }
  for (const std::string& id : kIds) EXPECT_TRUE(registered.count(id)) << id;
}

TEST(Catalogue, DescriptionsAreComplete) {
  for (const auto& [id, entry] : catalogue()) {
    SCOPED_TRACE(id);
    const EffectDescription& description = entry.description;
    EXPECT_FALSE(description.equation.empty());
    EXPECT_FALSE(description.explanation.empty());
    EXPECT_FALSE(description.channels.empty());
    EXPECT_FALSE(description.separated_by.empty());
    EXPECT_FALSE(description.parameters.empty());
    EXPECT_FALSE(description.confused_with.empty());
    for (const std::string& other : description.confused_with) {
      EXPECT_TRUE(catalogue().count(other)) << other;
      EXPECT_NE(other, id);
    }
    for (const EffectParameter& parameter : description.parameters) {
      EXPECT_LE(parameter.lowest, parameter.typical) << parameter.name;
      EXPECT_LE(parameter.typical, parameter.highest) << parameter.name;
      EXPECT_FALSE(parameter.unit.empty()) << parameter.name;
      EXPECT_FALSE(parameter.meaning.empty()) << parameter.name;
    }
  }
}

TEST(Catalogue, ScoredParametersHaveTheirNamesAndUnits) {
  for (const ScoredParameter& scored : kScored) {
    SCOPED_TRACE(scored.id + "." + scored.name);
    const auto& parameters = catalogue().find(scored.id)->second.description.parameters;
    const auto found = std::find_if(parameters.begin(), parameters.end(),
                                    [&](const EffectParameter& p) { return p.name == scored.name; });
    ASSERT_NE(found, parameters.end());
    EXPECT_EQ(found->unit, scored.unit);
  }
}

TEST(Catalogue, EveryEffectRunsWithItsTypicalValues) {
  for (const auto& [id, entry] : catalogue()) EXPECT_EQ(refusal({{id, {}}}), "") << id;
}

TEST(Catalogue, RefusesValuesJustOutsideTheirRangesAndTakesTheEnds) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  for (const auto& [id, entry] : catalogue()) {
    for (const EffectParameter& parameter : entry.description.parameters) {
      SCOPED_TRACE(id + "." + parameter.name);
      expect_mentions(refusal({{id, {{parameter.name, std::nextafter(parameter.lowest, -kFar)}}}}),
                      {id, parameter.name, "outside"});
      expect_mentions(refusal({{id, {{parameter.name, std::nextafter(parameter.highest, kFar)}}}}),
                      {id, parameter.name, "outside"});
      expect_mentions(refusal({{id, {{parameter.name, std::nan("")}}}}), {id, parameter.name, "outside"});
      EXPECT_EQ(refusal({{id, {{parameter.name, parameter.typical}}}}), "");
    }
  }
}

TEST(Catalogue, RefusesUnknownNames) {
  expect_mentions(refusal({{"duffing", {{"k4", 1.0}}}}), {"duffing", "k4", "relative_shift"});
  expect_mentions(refusal({{"warp_drive", {}}}), {"warp_drive", "duffing", "time_shift"});
}

TEST(Catalogue, RefusesRangesTurnedRound) {
  expect_mentions(refusal({{"oscillator_temperature", {{"board_low", 50.0}, {"board_high", 0.0}}}}),
                  {"oscillator_temperature", "board_low"});
  expect_mentions(refusal({{"frequency_split", {{"temperature_low", 50.0}, {"temperature_high", 0.0}}}}),
                  {"frequency_split", "temperature_low"});
  expect_mentions(refusal({{"rate_flicker", {{"duration", 10.0}, {"highest_frequency", 1.0}}}}),
                  {"rate_flicker", "duration"});
}

}  // namespace
}  // namespace hemi::physics

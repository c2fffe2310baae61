// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/telemetry_diagnosis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/golden/diagnosis/telemetry_writer.hpp"

namespace hemi::diagnosis {
namespace {

TelemetryDiagnosis diagnosed(const tests::Recipe& recipe) {
  return diagnose_telemetry(tests::telemetry(recipe), tests::nominal());
}

std::string moved(const TelemetryDiagnosis& result) {
  std::string text = "p " + std::to_string(result.recalibration_p);
  for (const auto& each : result.parameters)
    text += "\n" + each.name + " " + std::to_string((each.refitted - each.given) / each.deviation);
  return text;
}

// The one name, its first figure inside four times its 95 % interval's half width.
void expect_named(const TelemetryDiagnosis& result, const char* effect, double truth) {
  ASSERT_EQ(result.verdict, Verdict::named) << effect;
  ASSERT_EQ(result.named.size(), 1U) << effect;
  EXPECT_EQ(result.named[0].effect, effect);
  const Interval& first = result.named[0].figures.at(0);
  EXPECT_NEAR(first.figure.value, truth, 2.0 * (first.high - first.low)) << effect;
}

TEST(TelemetryDiagnosis, NothingLeftOutIsConsistent) {
  for (const std::uint64_t seed : {11U, 12U, 13U}) {
    const auto result = diagnosed({.seed = seed});
    EXPECT_EQ(result.verdict, Verdict::consistent) << seed << moved(result);
    EXPECT_TRUE(result.named.empty()) << seed;
  }
}

TEST(TelemetryDiagnosis, AWrongNumberIsRecalibratedAndNotNamed) {
  const auto result = diagnosed({.seed = 21, .tau_scale = 1.05});
  EXPECT_EQ(result.verdict, Verdict::recalibrate);
  EXPECT_TRUE(result.named.empty());
  EXPECT_NEAR(result.corrected.time_constant_s, 1900.0 * 1.05, 2.0);
}

TEST(TelemetryDiagnosis, NamesDuffing) {
  expect_named(diagnosed({.seed = 31, .duffing = 2e-7}), "duffing", 2e-7);
}

TEST(TelemetryDiagnosis, NamesGasLeak) {
  expect_named(diagnosed({.seed = 41, .leak_per_h = 1e-4}), "gas_leak", 1e-4);
}

TEST(TelemetryDiagnosis, NamesHysteresis) {
  // h' = (T' - |T'| h) / 6 degC between -r and r: the settled ways are farthest apart in the middle,
  // 2 (1 - 1 / cosh(r / 6 degC)).
  const Telemetry telemetry = tests::telemetry({.seed = 51, .hysteresis_dph = 0.5});
  const double half_range_degc = 0.5 * span(simulate(telemetry, tests::nominal()).smooth_degc);
  expect_named(diagnose_telemetry(telemetry, tests::nominal()), "thermal_hysteresis",
               0.5 * 2.0 * (1.0 - 1.0 / std::cosh(half_range_degc / 6.0)));
}

TEST(TelemetryDiagnosis, NamesAQuadratureThatStepsWithTemperature) {
  const auto result = diagnosed({.seed = 55, .strain_v = 4e-5});
  ASSERT_EQ(result.named.size(), 1U);
  EXPECT_EQ(result.named[0].effect, "frequency_split");
}

// Over slow curves a lag and a delay are the same but for their second order: neither may fall out unheard.
TEST(TelemetryDiagnosis, ALoopsLagIsNeverTakenForADelayAlone) {
  for (const double loop_s : {3.0, 6.0, 12.0}) {
    const auto result = diagnosed({.seed = 58, .loop_s = loop_s});
    const auto holds_lag = [](const Explanation& entry) {
      return entry.effect == "pll_lag" ||
             std::ranges::any_of(entry.near, [](const auto& rival) { return rival.first == "pll_lag"; });
    };
    EXPECT_TRUE(std::ranges::any_of(result.named, holds_lag) ||
                std::ranges::any_of(result.ambiguous, holds_lag))
        << loop_s;
    EXPECT_TRUE(std::ranges::none_of(result.named, [](const Explanation& e) {
      return e.effect == "time_shift";
    })) << loop_s;
  }
}

NominalModel with_names(const TelemetryDiagnosis& result) {
  NominalModel model = result.corrected;
  for (const auto& entry : result.named)
    model.effects.push_back({entry.effect, entry.form, entry.shape, entry.coefficients});
  return model;
}

// Fitted on one run, consistent on another; and what is given is taken, not looked for again: without the
// effect the same model is wrong.
TEST(TelemetryDiagnosis, AModelThatHasTheEffectIsConsistentWithAnotherRun) {
  const NominalModel corrected = with_names(diagnosed({.seed = 31, .duffing = 2e-7}));
  ASSERT_EQ(corrected.effects.size(), 1U);
  EXPECT_EQ(diagnose_telemetry(tests::telemetry({.seed = 32, .duffing = 2e-7}), corrected).verdict,
            Verdict::consistent);
  const auto without = diagnose_telemetry(tests::telemetry({.seed = 33}), corrected);
  ASSERT_EQ(without.named.size(), 1U);
  EXPECT_EQ(without.named[0].effect, "duffing");
  EXPECT_NEAR(without.named[0].coefficients.at(0) / -corrected.effects[0].coefficients.at(0), 1.0, 0.1);
}

TEST(TelemetryDiagnosis, AModelsEffectWithOtherNumbersThanItsFormIsRefused) {
  NominalModel model = with_names(diagnosed({.seed = 31, .duffing = 2e-7}));
  model.effects.at(0).coefficients.push_back(1.0);
  EXPECT_THROW(diagnose_telemetry(tests::telemetry({.seed = 32}), model), BadEffect);
  model.effects[0].coefficients.pop_back();
  model.effects[0].shape.push_back(1.0);
  EXPECT_THROW(diagnose_telemetry(tests::telemetry({.seed = 32}), model), BadEffect);
}

// The case went on along its curve while nothing was recorded: no effect, but a resonator that is elsewhere.
TEST(TelemetryDiagnosis, APowerCutAloneIsConsistent) {
  for (const std::uint64_t seed : {71U, 72U}) {
    const auto result = diagnosed({.seed = seed, .cut_rows = 1500});
    EXPECT_EQ(result.verdict, Verdict::consistent) << seed << moved(result);
  }
}

TEST(TelemetryDiagnosis, NamesWarmthThatFadesInAPowerCut) {
  expect_named(diagnosed({.seed = 73, .warmth_degc = 0.5, .cut_rows = 1500}), "self_heating", 0.5);
}

// A resonator that began colder has the same trace: the interval must reach as far, and no farther where
// nothing can be hidden.
TEST(TelemetryDiagnosis, WarmthThatTheStartMayHoldIsInTheInterval) {
  const auto hidden = diagnosed({.seed = 74, .warmth_degc = 0.1, .stem_degc = 0.4});
  expect_named(hidden, "self_heating", 0.5);
  const Interval& rise = hidden.named.at(0).figures.at(0);
  EXPECT_LT(rise.low, 0.1);
  EXPECT_GT(rise.high, 0.5);
  EXPECT_LT(rise.high, 0.6);
  const auto plain = diagnosed({.seed = 75, .warmth_degc = 0.1});
  expect_named(plain, "self_heating", 0.1);
  EXPECT_LT(plain.named.at(0).figures.at(0).high, 0.2);
}

// As slow as a random walk is, but no noise: its innovations show a line.
TEST(TelemetryDiagnosis, ASlowWaveIsNoRandomWalk) {
  const auto result = diagnosed({.seed = 81, .wave_dph = 0.3});
  EXPECT_EQ(result.verdict, Verdict::unknown);
  EXPECT_TRUE(result.named.empty());
}

// A walk would take it as well; the temperature does it better.
TEST(TelemetryDiagnosis, AWeakRippleOverTemperatureIsNoRandomWalk) {
  for (const double ripple_dph : {0.1, 0.12}) {
    const auto result = diagnosed({.seed = 91, .ripple_dph = ripple_dph});
    EXPECT_EQ(result.verdict, Verdict::unknown) << ripple_dph;
    EXPECT_TRUE(result.named.empty()) << ripple_dph;
  }
}

// Start temperature and slope of the frequency show as their product alone: free, both ran off.
TEST(TelemetryDiagnosis, AResonatorThatHasNotSettledAtOneTemperatureIsConsistent) {
  for (const std::uint64_t seed : {111U, 112U}) {
    const auto result = diagnosed({.seed = seed, .swing = 0.0, .start_degc = -0.6});
    EXPECT_EQ(result.verdict, Verdict::consistent) << seed << moved(result);
    EXPECT_TRUE(std::ranges::none_of(
        result.parameters, [](const Moved& each) { return each.name == "frequency.coefficients_hz[1]"; }));
  }
}

TEST(TelemetryDiagnosis, WhatIsInNoCatalogueIsUnknownAndWhereItLivesIsSaid) {
  const auto result = diagnosed({.seed = 61, .ripple_dph = 0.6});
  EXPECT_EQ(result.verdict, Verdict::unknown);
  EXPECT_TRUE(result.named.empty());
  ASSERT_EQ(result.remainders.size(), 1U);
  EXPECT_EQ(result.remainders[0].output, Output::rate);
  EXPECT_EQ(result.remainders[0].variable, "resonator_temp_degc");
}

}  // namespace
}  // namespace hemi::diagnosis

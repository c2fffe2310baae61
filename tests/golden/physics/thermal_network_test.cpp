// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/thermal_network.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "golden/physics/world.hpp"

namespace hemi::physics {
namespace {

/// Response of distinct poles in a chain to a ramp of 1 degC/s from rest, by partial fractions:
/// t - sum tau_k + sum_k tau_k^n/prod_(j != k)(tau_k - tau_j) exp(-t/tau_k).
double ramp_response(const std::vector<double>& tau_s, double t_s) {
  double value = t_s;
  for (std::size_t k = 0; k < tau_s.size(); ++k) {
    double weight = tau_s[k];
    for (std::size_t j = 0; j < tau_s.size(); ++j) {
      if (j != k) weight *= tau_s[k] / (tau_s[k] - tau_s[j]);
    }
    value += -tau_s[k] + weight * std::exp(-t_s / tau_s[k]);
  }
  return value;
}

TEST(ThermalNetwork, FollowsARampExactlyHoweverLongTheSteps) {
  Instrument instrument;
  instrument.case_time_constant_s = 500.0;
  instrument.stem_time_constant_s = 300.0;
  instrument.shell_time_constant_s = 2600.0;
  for (const double step_s : {1.0, 7.0, 900.0}) {
    ThermalNetwork network(instrument, 20.0);
    for (int i = 1; i <= 20; ++i) {
      const double t = step_s * i;
      network.advance(20.0 - 0.01 * t, step_s);
      // doubles of 20 degC, and t - sum tau that nearly cancels
      EXPECT_NEAR(network.case_degc(), 20.0 - 0.01 * ramp_response({500.0}, t), 1e-11);
      EXPECT_NEAR(network.stem_degc(), 20.0 - 0.01 * ramp_response({500.0, 300.0}, t), 1e-11);
      EXPECT_NEAR(network.shell_degc(), 20.0 - 0.01 * ramp_response({500.0, 300.0, 2600.0}, t), 1e-11);
      EXPECT_NEAR(network.shell_slope_degc_s(), (network.stem_degc() - network.shell_degc()) / 2600.0, 1e-15);
    }
  }
}

TEST(ThermalNetwork, EqualTimeConstantsAreNoSpecialCase) {
  Instrument instrument;
  instrument.case_time_constant_s = instrument.stem_time_constant_s = instrument.shell_time_constant_s =
      400.0;
  ThermalNetwork network(instrument, 0.0);
  network.advance(1.0, 1e-9);  // a step
  double t = 0.0;
  for (int i = 0; i < 50; ++i) {
    network.advance(1.0, 60.0);
    t += 60.0;
    const double u = t / 400.0;
    EXPECT_NEAR(network.shell_degc(), 1.0 - std::exp(-u) * (1.0 + u + 0.5 * u * u), 1e-9);
  }
}

TEST(ThermalNetwork, ZeroTimeConstantsFollowAtOnce) {
  Instrument instrument;
  instrument.case_time_constant_s = instrument.stem_time_constant_s = instrument.shell_time_constant_s = 0.0;
  ThermalNetwork network(instrument, 20.0);
  network.advance(15.0, 10.0);
  EXPECT_EQ(network.case_degc(), 15.0);
  EXPECT_EQ(network.shell_degc(), 15.0);
  EXPECT_DOUBLE_EQ(network.shell_slope_degc_s(), -0.5);
}

TEST(World, BoardStandsOverTheCaseByItsRiseSincePowerOn) {
  Instrument instrument;
  Environment e;
  e.power_on_s = -300.0;
  World world(instrument, {}, e, 0);
  EXPECT_NEAR(world.conditions().temperatures.board_degc, 20.0 + 8.0 * (1.0 - std::exp(-300.0 / 900.0)),
              1e-12);
  for (int i = 1; i <= 100; ++i) {
    e.time_s = 13.0 * i;
    e.chamber_degc = 20.0 - 0.01 * e.time_s;
    world.advance(e, 1.0);
    EXPECT_NEAR(world.conditions().temperatures.board_degc - world.conditions().temperatures.case_degc,
                8.0 * (1.0 - std::exp(-(e.time_s + 300.0) / 900.0)), 1e-11);
  }
}

TEST(World, AddsEveryTermOfTheDrift) {
  // The shell follows a ramp without lag: f and df/dt are known.
  Instrument instrument;
  instrument.case_time_constant_s = instrument.shell_time_constant_s = 0.0;
  for (std::size_t term = 0; term < 10; ++term) {
    instrument.bias_terms_dph.fill(0.0);
    instrument.bias_terms_dph[term] = 2.0;
    Environment e;
    e.rate_dph = 7.0;
    World world(instrument, {}, e, 0);
    e.time_s = 50.0;
    e.chamber_degc = 19.0;
    world.advance(e, 1.0);
    const double f =
        4424.90095 + 19.0 * (0.371555556 + 19.0 * (-9.70238095e-4 + 19.0 * 1.52777778e-5)) - 4432.07;
    const double df =
        (0.371555556 + 19.0 * (-2.0 * 9.70238095e-4 + 19.0 * 3.0 * 1.52777778e-5)) * (-1.0 / 50.0);
    const double powers[10] = {1.0,          f,      f * f,      f * f * f,  df, df * df,
                               df * df * df, f * df, f * f * df, f * df * df};
    EXPECT_NEAR(world.parameters().rate_rad_s / kRadPerSecondPerDph, 7.0 + 2.0 * powers[term], 1e-11) << term;
  }
}

TEST(World, RefusesTimeThatRunsBackwards) {
  World world(Instrument{}, {}, Environment{}, 0);
  Environment e;
  e.time_s = -1.0;
  EXPECT_THROW(world.advance(e, 1.0), std::invalid_argument);
}

TEST(World, AnEffectKeepsItsNoiseWhenOthersJoin) {
  Environment e;
  World alone(Instrument{}, {{"rate_random_walk", {}}}, e, 4);
  World joined(Instrument{},
               {{"duffing", {}}, {"rate_random_walk", {}}, {"rate_random_walk", {{"density", 0.0}}}}, e, 4);
  for (int i = 1; i < 10; ++i) {
    e.time_s = i;
    alone.advance(e, 1.0);
    joined.advance(e, 1.0);
    EXPECT_NE(alone.parameters().rate_rad_s, 0.0);
    EXPECT_EQ(alone.parameters().rate_rad_s, joined.parameters().rate_rad_s);
  }
}

}  // namespace
}  // namespace hemi::physics

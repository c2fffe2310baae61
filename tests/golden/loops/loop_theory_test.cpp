// SPDX-License-Identifier: Apache-2.0
#include "golden/loops/loop_theory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "golden/loops/control.hpp"

namespace {

using namespace hemi;
constexpr double kTurn = 2.0 * std::numbers::pi;

TEST(LoopTheory, ASlowLoopIsTheTextbooksSecondOrder) {
  // At 0.5 Hz the delay of 1.2 ms turns 0.2 degrees and the sampled integral is a continuous one:
  // T = (2 z wn s + wn^2) / (s^2 + 2 z wn s + wn^2), 2 z wn = kp b, wn^2 = ki b / tick.
  const auto design = loops::design_control({}, loops::CoreSampling::reference());
  loops::Loop loop = design.amplitude;
  loop.plant.pole_per_s = 0.0;
  const double b = loop.plant.gain_per_s, tick_s = loop.plant.decimation / loop.plant.adc_rate_hz;
  const double first = loop.gains.proportional * b, second = loop.gains.integral * b / tick_s;
  for (const double f : {0.01, 0.05, 0.2, 0.5, 1.0}) {
    const std::complex<double> s{0.0, kTurn * f};
    const std::complex<double> expected = (first * s + second) / (s * s + first * s + second);
    // One delay of d seconds changes T by at most |s d T (1 - T)|.
    const double delay_s = loop.plant.delay_samples / loop.plant.adc_rate_hz + tick_s;
    EXPECT_LT(std::abs(loop.closed(f) - expected),
              1.05 * std::abs(s * delay_s * expected * (1.0 - expected)) + 1e-6);
  }
}

TEST(LoopTheory, DesignsWhatWasAskedForWithItsMargin) {
  for (const auto sampling : {loops::CoreSampling::reference(), loops::CoreSampling::wide()}) {
    const auto d = loops::design_control({}, sampling);
    EXPECT_NEAR(d.reference_phase.bandwidth_hz(), 10.0, 1e-6);
    EXPECT_NEAR(d.rebalance.bandwidth_hz(), 40.0, 1e-6);
    EXPECT_NEAR(d.quadrature.bandwidth_hz(), 1.0, 1e-6);
    EXPECT_NEAR(d.amplitude.bandwidth_hz(), 0.5, 1e-6);
    for (const auto* loop : {&d.reference_phase, &d.rebalance, &d.quadrature, &d.amplitude}) {
      EXPECT_GE(loop->phase_margin_deg(), 60.0);
      EXPECT_NEAR(std::abs(loop->open(loop->crossover_hz())), 1.0, 1e-9);
    }
  }
}

TEST(LoopTheory, RefusesWhatTheDelayForbids) {
  const auto plant = loops::design_control({}, loops::CoreSampling::reference()).rebalance.plant;
  EXPECT_NO_THROW(loops::design(plant, 60.0));
  EXPECT_THROW(loops::design(plant, 150.0), std::invalid_argument);
  EXPECT_THROW(loops::design(plant, 0.0), std::invalid_argument);
  EXPECT_THROW(loops::design(plant, NAN), std::invalid_argument);
}

TEST(Control, RegistersFitTheirFormats) {
  for (const auto sampling : {loops::CoreSampling::reference(), loops::CoreSampling::wide()}) {
    std::array<double, config::register_count> v{};
    loops::set_control(v, {}, sampling);
    for (int i = 0; i < config::register_count; ++i) {
      const auto format = config::registers[i].format;
      EXPECT_LT(std::abs(std::ldexp(v[static_cast<std::size_t>(i)], format.fraction)),
                std::ldexp(1.0, format.width - 1))
          << config::registers[i].name;
    }
  }
}

}  // namespace

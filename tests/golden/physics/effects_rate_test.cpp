// SPDX-License-Identifier: Apache-2.0
// Effects that add to the rate, and those that change how heat reaches the shell.
#include "tests/golden/physics/effects_support.hpp"

#include <array>

namespace hemi::physics {
namespace {

const Scene& scene() {
  static const Scene instance;
  return instance;
}

const Environment& input(std::size_t i) {
  return scene().inputs[i];
}

/// Poles in a chain behind the scene's chamber, by the classical Runge-Kutta method in steps of a second: its
/// error, about (1 s/tau)^4/120 of the change in a step, is below 1e-10 for the time constants here. One row
/// an input.
template <std::size_t N>
std::vector<std::array<double, N>> integrate_chain(const std::array<double, N>& tau_s) {
  using State = std::array<double, N>;
  const auto slope = [&](const State& x, double u) {
    State d{};
    for (std::size_t k = 0; k < N; ++k) d[k] = ((k == 0 ? u : x[k - 1]) - x[k]) / tau_s[k];
    return d;
  };
  const auto along = [](const State& x, const State& d, double h) {
    State y = x;
    for (std::size_t k = 0; k < N; ++k) y[k] += h * d[k];
    return y;
  };
  State x;
  x.fill(input(0).chamber_degc);
  std::vector<State> rows = {x};
  for (std::size_t i = 1; i < scene().inputs.size(); ++i) {
    const double u0 = input(i - 1).chamber_degc;
    const double per_s = (input(i).chamber_degc - u0) / 10.0;
    for (int s = 0; s < 10; ++s) {
      const double u = u0 + per_s * s;
      const State k1 = slope(x, u);
      const State k2 = slope(along(x, k1, 0.5), u + 0.5 * per_s);
      const State k3 = slope(along(x, k2, 0.5), u + 0.5 * per_s);
      const State k4 = slope(along(x, k3, 1.0), u + per_s);
      for (std::size_t k = 0; k < N; ++k) x[k] += (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k]) / 6.0;
    }
    rows.push_back(x);
  }
  return rows;
}

double cubic_hz(double degc) {
  return 4424.90095 + degc * (0.371555556 + degc * (-9.70238095e-4 + degc * 1.52777778e-5));
}

TEST(EffectSignature, ThermalSecondTimeConstant) {
  const auto chain = integrate_chain<3>({600.0, 700.0, 2600.0});
  expect_signature(scene(), {"thermal_second_time_constant", {{"second_time_constant", 700.0}}},
                   {{"frequency_hz",
                     [&](std::size_t i) {
                       return cubic_hz(chain[i][2]) - cubic_hz(scene().world[i].temperatures.shell_degc);
                     }}},
                   1e-8);
}

TEST(EffectSignature, SelfHeating) {
  // The chamber is at 20 degC, the power comes on with the recording.
  expect_signature(scene(), {"self_heating", {{"rise", 2.0}, {"time_constant", 1200.0}}},
                   {{"frequency_hz",
                     [](std::size_t i) {
                       const double degc = scene().world[i].temperatures.shell_degc;
                       return cubic_hz(degc + 2.0 * (1.0 - std::exp(-input(i).time_s / 1200.0))) -
                              cubic_hz(degc);
                     }}},
                   1e-8);
}

TEST(EffectSignature, SelfHeatingStartsAnewAfterAPowerCycle) {
  Environment e;
  World world(plain_instrument(), {{"self_heating", {{"rise", 2.0}, {"time_constant", 100.0}}}}, e, 0);
  const auto at = [&](double time_s, double power_on_s) {
    e.time_s = time_s;
    e.power_on_s = power_on_s;
    world.advance(e, 1.0);
    return world.conditions().temperatures.shell_degc - 20.0;
  };
  const double warm = at(300.0, 0.0);
  EXPECT_NEAR(warm, 2.0 * (1.0 - std::exp(-3.0)), 1e-12);
  const double cooled = at(350.0, 400.0);
  EXPECT_NEAR(cooled, warm * std::exp(-0.5), 1e-12);
  // off for another 50 s and on for 100 s, within one step
  EXPECT_NEAR(at(500.0, 400.0), 2.0 + (warm * std::exp(-1.0) - 2.0) * std::exp(-1.0), 1e-12);
}

TEST(EffectSignature, ThermalGradientBias) {
  const auto chain = integrate_chain<2>({600.0, 500.0});
  // The effect takes the case as linear over a step of 10 s. Its curvature, at most the chamber's 1/60 degC/s
  // over 600 s and at the turn twice that, makes (10 s)^2/8 of it, 7e-4 degC, which the node sees for 1/50 of
  // its time constant.
  expect_signature(scene(), {"thermal_gradient_bias", {{"gain", 3.0}, {"node_time_constant", 500.0}}},
                   {{"rate_dph", [&](std::size_t i) { return 3.0 * (chain[i][0] - chain[i][1]); }}}, 1e-4);
}

TEST(EffectSignature, ThermalHysteresis) {
  // Eight play operators, each at rest while the temperature moves within its width.
  std::array<double, 8> play;
  play.fill(20.0);
  std::vector<double> expected;
  for (const Conditions& now : scene().world) {
    double sum = 0.0;
    for (std::size_t k = 0; k < play.size(); ++k) {
      const double radius = 60.0 / 32.0 * static_cast<double>(k + 1);
      const double t = now.temperatures.shell_degc;
      if (t - play[k] > radius) play[k] = t - radius;
      if (play[k] - t > radius) play[k] = t + radius;
      sum += play[k] - t;
    }
    expected.push_back(0.8 * sum / (2.0 * 60.0 / 32.0 * 36.0));
  }
  expect_signature(scene(), {"thermal_hysteresis", {{"loop_height", 0.8}, {"span", 60.0}}},
                   {{"rate_dph", [&](std::size_t i) { return expected[i]; }}}, 1e-8);
}

/// Rate of thermal_hysteresis along temperatures of the shell, without any lag.
std::vector<double> hysteresis_dph(const std::vector<double>& path_degc, double interval_s) {
  Instrument direct = plain_instrument();
  direct.case_time_constant_s = direct.shell_time_constant_s = 0.0;
  Environment e;
  e.chamber_degc = path_degc.front();
  World world(direct, {{"thermal_hysteresis", {{"loop_height", 0.4}, {"span", 60.0}}}}, e, 0);
  std::vector<double> rates;
  for (const double degc : path_degc) {
    e.time_s += interval_s;
    e.chamber_degc = degc;
    world.advance(e, 1.0);
    rates.push_back(world.parameters().rate_rad_s / kRadPerSecondPerDph);
  }
  return rates;
}

std::vector<double> sweep(std::vector<double> path, double to_degc) {
  const double from = path.back();
  for (int i = 1; i <= 120; ++i) path.push_back(from + (to_degc - from) * i / 120.0);
  return path;
}

TEST(EffectSignature, ThermalHysteresisLoopHasItsHeightClosesAndKnowsNoSpeed) {
  const std::vector<double> path = sweep(sweep(sweep(sweep({-20.0}, 40.0), -20.0), 40.0), -20.0);
  const std::vector<double> slow = hysteresis_dph(path, 100.0);
  EXPECT_EQ(slow, hysteresis_dph(path, 1.0));
  EXPECT_NEAR(path[300], 10.0, 1e-12);
  EXPECT_NEAR(slow[300 - 120] - slow[300], 0.4, 1e-12) << "down less up, in the middle";
  for (std::size_t i = 121; i <= 240; ++i) EXPECT_NEAR(slow[i], slow[i + 240], 1e-12) << "the loop closes";
  // return-point memory: a minor loop of 5 degC leaves no trace
  const std::vector<double> with_minor =
      hysteresis_dph(sweep(sweep(sweep(sweep({-20.0}, 10.0), 5.0), 10.0), 40.0), 1.0);
  const std::vector<double> without = hysteresis_dph(sweep(sweep({-20.0}, 10.0), 40.0), 1.0);
  for (std::size_t i = 120; i <= 240; ++i) EXPECT_NEAR(with_minor[i + 240], without[i], 1e-12);
}

TEST(EffectSignature, ScaleFactorTemperature) {
  expect_signature(scene(), {"scale_factor_temperature", {{"per_degc", 1e-4}}},
                   {{"rate_dph",
                     [](std::size_t i) {
                       return input(i).rate_dph * 1e-4 * (scene().world[i].temperatures.shell_degc - 20.0);
                     }}},
                   1e-8);
}

TEST(EffectSignature, ScaleFactorNonlinearity) {
  expect_signature(scene(), {"scale_factor_nonlinearity", {{"cubic", 5.0}, {"quadratic", 2.0}}},
                   {{"rate_dph",
                     [](std::size_t i) {
                       const double w = input(i).rate_dph / 1e5;
                       return 2.0 * w * w + 5.0 * w * w * w;
                     }}},
                   1e-8);
}

TEST(EffectSignature, ScaleFactorsActOnTheSlopeOfTheRateAsWell) {
  Environment e;
  e.chamber_degc = 30.0;
  e.rate_dph = 5e4;
  e.rate_slope_dph_s = 100.0;
  const auto slope_dph_s = [&](const ActiveEffect& effect) {
    return World(plain_instrument(), {effect}, e, 0).parameters().rate_slope_rad_s2 / kRadPerSecondPerDph;
  };
  EXPECT_NEAR(slope_dph_s({"scale_factor_temperature", {{"per_degc", 1e-3}}}), 101.0, 1e-9);
  // d/dt of 200 (W/1e5)^2 + 500 (W/1e5)^3 at half of 1e5, W' = 1e-3 of it
  EXPECT_NEAR(slope_dph_s({"scale_factor_nonlinearity", {{"cubic", 500.0}, {"quadratic", 200.0}}}),
              100.0 + (2.0 * 200.0 * 0.5 + 3.0 * 500.0 * 0.25) * 1e-3, 1e-9);
}

TEST(EffectSignature, EarthRate) {
  expect_signature(scene(), {"earth_rate", {{"latitude", 40.0}, {"tilt", -10.0}}},
                   {{"rate_dph", [](std::size_t) { return 15.041 * 0.5; }}}, 1e-8);
}

TEST(EffectSignature, GSensitivity) {
  expect_signature(
      scene(), {"g_sensitivity", {{"per_g", 0.7}, {"per_g2", 0.2}}},
      {{"rate_dph",
        [](std::size_t i) { return 0.7 * input(i).accel_g + 0.2 * input(i).accel_g * input(i).accel_g; }}},
      1e-8);
}

/// Rate that an effect adds at rest, once a second.
std::vector<double> at_rest_dph(const ActiveEffect& effect, std::size_t count, std::uint64_t seed) {
  Environment e;
  World world(plain_instrument(), {effect}, e, seed);
  std::vector<double> rates;
  for (std::size_t i = 0; i < count; ++i) {
    e.time_s += 1.0;
    world.advance(e, 1.0);
    rates.push_back(world.parameters().rate_rad_s / kRadPerSecondPerDph);
  }
  return rates;
}

TEST(EffectSignature, RateRandomWalkHasWhiteIncrements) {
  constexpr std::size_t kCount = 20000;
  const std::vector<double> walk = at_rest_dph({"rate_random_walk", {{"density", 0.02}}}, kCount, 5);
  double variance = 0.0;
  double neighbours = 0.0;
  for (std::size_t i = 2; i < kCount; ++i) {
    variance += std::pow(walk[i] - walk[i - 1], 2);
    neighbours += (walk[i] - walk[i - 1]) * (walk[i - 1] - walk[i - 2]);
  }
  // five standard deviations of a sample variance and of a sample correlation
  EXPECT_NEAR(variance / kCount / (0.02 * 0.02), 1.0, 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(neighbours / variance, 0.0, 5.0 / std::sqrt(1.0 * kCount));
  expect_signature(scene(), {"rate_random_walk", {{"density", 0.0}}}, {});
  EXPECT_NE(walk, at_rest_dph({"rate_random_walk", {{"density", 0.02}}}, kCount, 6));
  EXPECT_EQ(walk, at_rest_dph({"rate_random_walk", {{"density", 0.02}}}, kCount, 5));
}

TEST(EffectSignature, RateFlickerHasItsDeviationAndAFlatAllanDeviation) {
  constexpr std::size_t kCount = 16384;
  constexpr int kSeeds = 40;
  const std::vector<std::size_t> averages = {16, 128, 1024};
  std::vector<double> allan(averages.size(), 0.0);
  double variance = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const std::vector<double> rate =
        at_rest_dph({"rate_flicker", {{"density", 0.3}, {"duration", 1.0 * kCount}}}, kCount,
                    static_cast<std::uint64_t>(seed));
    std::vector<double> sums(kCount + 1, 0.0);
    double squares = 0.0;
    for (std::size_t i = 0; i < kCount; ++i) {
      sums[i + 1] = sums[i] + rate[i];
      squares += rate[i] * rate[i];
    }
    variance += (squares - sums[kCount] * sums[kCount] / kCount) / kCount / kSeeds;
    for (std::size_t m = 0; m < averages.size(); ++m) {
      const std::size_t n = averages[m];
      const std::size_t pairs = kCount / n - 1;
      for (std::size_t k = 0; k < pairs; ++k) {
        const double difference =
            (sums[(k + 2) * n] - 2.0 * sums[(k + 1) * n] + sums[k * n]) / static_cast<double>(n);
        allan[m] += 0.5 * difference * difference / static_cast<double>(pairs) / kSeeds;
      }
    }
  }
  // The variance of one record scatters like that of about a dozen independent numbers (equal power in each
  // octave, the slowest octaves holding one or two periods): 0.4 of itself; five deviations of the mean
  // of 40. The end of the law lies within a quarter of a decade of its nominal place: 0.6/11 more.
  EXPECT_NEAR(variance / 0.09, 1.0, 5.0 * 0.4 / std::sqrt(1.0 * kSeeds) + 0.05);
  const double h = 0.09 / (std::log(1.78 * kCount) + 0.915);
  for (std::size_t m = 0; m < averages.size(); ++m) {
    // chi-square of its pairs, whose differences are correlated by a quarter and less; five deviations. What
    // lies beyond the end of the law adds white noise, a few samples' worth of h.
    const double pairs = 1.0 * kSeeds * static_cast<double>(kCount / averages[m] - 1);
    const double allowed = 5.0 * std::sqrt(2.0 / pairs * 1.5) + 1.0 / static_cast<double>(averages[m]);
    EXPECT_NEAR(allan[m] / (2.0 * std::numbers::ln2 * h), 1.0, allowed) << averages[m] << " s";
  }
}

}  // namespace
}  // namespace hemi::physics

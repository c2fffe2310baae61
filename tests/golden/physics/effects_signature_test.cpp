// SPDX-License-Identifier: Apache-2.0
// What each effect of the resonator and its electronics does to the telemetry, by its equation written once
// more.
#include "tests/golden/physics/effects_support.hpp"

#include "golden/physics/converters.hpp"

namespace hemi::physics {
namespace {

const Scene& scene() {
  static const Scene instance;
  return instance;
}

/// A second one with another amplitude.
const Scene& scene_at_08() {
  static const Scene instance(0.8);
  return instance;
}

double shell(const Scene& s, std::size_t i) {
  return s.world[i].temperatures.shell_degc;
}
double board(const Scene& s, std::size_t i) {
  return s.world[i].temperatures.board_degc;
}

double cubic_hz(double degc) {
  return 4424.90095 + degc * (0.371555556 + degc * (-9.70238095e-4 + degc * 1.52777778e-5));
}

// The drive answers through the amplitude loop, which lags a ramp by a fraction of a second: of hours, here.
constexpr double kLoopLag = 1e-5;
// The nominal drive holds w'/(2 w), up to 3.5e-4 of 1/tau in this scene, which is no loss and does not scale
// with one.
constexpr double kAdiabatic = 5e-4;

TEST(EffectSignature, FrequencyPolynomialOrder) {
  expect_signature(scene(), {"frequency_polynomial_order", {{"a4", 2e-8}, {"a5", 1e-9}, {"reference", 5.0}}},
                   {{"frequency_hz", [](std::size_t i) {
                       const double t = shell(scene(), i) - 5.0;
                       return 2e-8 * std::pow(t, 4) + 1e-9 * std::pow(t, 5);
                     }}});
}

TEST(EffectSignature, FrequencyAgeing) {
  const std::vector<std::function<double(double)>> laws = {
      [](double t_s) { return std::log(1.0 + t_s / 1000.0); },
      [](double t_s) { return 1.0 - std::exp(-t_s / 1000.0); }, [](double t_s) { return t_s; }};
  for (std::size_t law = 0; law < laws.size(); ++law) {
    expect_signature(scene(),
                     {"frequency_ageing",
                      {{"total", 0.02},
                       {"duration", 7000.0},
                       {"time_constant", 1000.0},
                       {"law", static_cast<double>(law)}}},
                     {{"frequency_hz", [&](std::size_t i) {
                         return 0.02 * laws[law](scene().inputs[i].time_s) / laws[law](7000.0);
                       }}});
  }
}

TEST(EffectSignature, OscillatorTemperature) {
  // turning points 0 and 40 degC inside -12 .. 48: u^3 - 1200 u is +-16000 there and -11 200 and -1 792 more
  // inside
  expect_signature(scene(),
                   {"oscillator_temperature",
                    {{"ppm_span", 5.0},
                     {"inflection", 20.0},
                     {"turning", 20.0},
                     {"board_low", -12.0},
                     {"board_high", 48.0}}},
                   {{"frequency_hz", [](std::size_t i) {
                       const double u = board(scene(), i) - 20.0;
                       return -scene().nominal[i].frequency_hz * 5e-6 * (u * u * u - 1200.0 * u) / 32000.0;
                     }}});
}

TEST(EffectSignature, OscillatorAgeing) {
  expect_signature(scene(), {"oscillator_ageing", {{"rate", 2.0}}},
                   {{"frequency_hz", [](std::size_t i) {
                       const Scene& s = scene();
                       return -s.nominal[i].frequency_hz * 2e-6 * s.inputs[i].time_s / 86400.0;
                     }}});
}

TEST(EffectSignature, Duffing) {
  for (const Scene* s : {&scene(), &scene_at_08()}) {
    const double a = s->inputs.front().amplitude_setpoint;
    expect_signature(*s, {"duffing", {{"relative_shift", 3e-7}}},
                     {{"frequency_hz", [&](std::size_t i) { return cubic_hz(shell(*s, i)) * 3e-7 * a * a; }}},
                     1e-6);
  }
  // df/f = (3/8) k3 a^2/w^2 with a displacement of 2 V at nominal amplitude
  expect_signature(scene(),
                   {"duffing", {{"relative_shift", 0.0}, {"k3", 400.0}, {"volts_per_amplitude", 2.0}}},
                   {{"frequency_hz",
                     [](std::size_t i) {
                       const double w = 2.0 * std::numbers::pi * cubic_hz(shell(scene(), i));
                       return w / (2.0 * std::numbers::pi) * 0.375 * 400.0 * 4.0 / (w * w);
                     }}},
                   1e-6);
}

TEST(EffectSignature, QuadraticStiffness) {
  for (const Scene* s : {&scene(), &scene_at_08()}) {
    const double a = s->inputs.front().amplitude_setpoint;
    expect_signature(*s, {"quadratic_stiffness", {{"k2", 1e6}}},
                     {{"frequency_hz",
                       [&](std::size_t i) {
                         const double f = cubic_hz(shell(*s, i));
                         const double w = 2.0 * std::numbers::pi * f;
                         return -5.0 / 12.0 * std::pow(1e6 * a / (w * w), 2) * f;
                       }}},
                     1e-6);
  }
}

TEST(EffectSignature, DampingNonlinearity) {
  for (const Scene* s : {&scene(), &scene_at_08()}) {
    const double a = s->inputs.front().amplitude_setpoint;
    // The mismatch, 1 % along 22.5 degrees, is part of the linear drive and does not grow.
    const double linear = 1.0 + 0.5 * 0.01 * std::cos(std::numbers::pi / 8.0);
    expect_signature(
        *s, {"damping_nonlinearity", {{"relative", 0.02}, {"quadratic", 0.01}}},
        {{"drive_v",
          [&](std::size_t i) { return s->nominal[i].drive_v * (0.01 * a + 0.02 * a * a) / linear; }}},
        kAdiabatic);
  }
}

TEST(EffectSignature, ElectrostaticSoftening) {
  expect_signature(scene(), {"electrostatic_softening", {{"relative_shift", -5e-5}, {"nominal_supply", 5.0}}},
                   {{"frequency_hz",
                     [](std::size_t i) {
                       const double v = scene().inputs[i].supply_v / 5.0;
                       return -5e-5 * (v * v - 1.0) * cubic_hz(shell(scene(), i));
                     }}},
                   1e-6);
  expect_signature(scene(), {"electrostatic_softening", {{"relative_shift", 0.0}, {"scale_shift", 0.5}}},
                   {{"rate_dph",
                     [](std::size_t i) {
                       const double gain = 1.0 + 0.5 * (scene().inputs[i].supply_v / 5.0 - 1.0);
                       return scene().nominal[i].rate_dph * (1.0 / gain - 1.0);
                     }},
                    {"drive_v",
                     [](std::size_t i) {
                       const double gain = 1.0 + 0.5 * (scene().inputs[i].supply_v / 5.0 - 1.0);
                       return scene().nominal[i].drive_v * (1.0 / gain - 1.0);
                     }}},
                   1e-6);
}

TEST(EffectSignature, GasLeak) {
  expect_signature(scene(), {"gas_leak", {{"rate", 0.02}, {"initial", 0.1}}},
                   {{"drive_v",
                     [](std::size_t i) {
                       // the drive of the isotropic damping alone: 10 V/400
                       return 10.0 / 400.0 * (0.1 + 0.02 * scene().inputs[i].time_s / 3600.0);
                     }}},
                   kLoopLag);
}

TEST(EffectSignature, DampingTemperature) {
  expect_signature(scene(), {"damping_temperature", {{"peak", 0.1}, {"centre", 5.0}, {"width", 8.0}}},
                   {{"drive_v",
                     [](std::size_t i) {
                       // Debye: 2 x/(1 + x^2) with x = w times the relaxation time
                       const double x = std::exp((shell(scene(), i) - 5.0) / 8.0);
                       return 10.0 / 400.0 * 0.1 * 2.0 * x / (1.0 + x * x);
                     }}},
                   kLoopLag);
}

TEST(EffectSignature, DampingAnisotropyAndForcerMisalignmentLookAlike) {
  for (const Scene* s : {&scene(), &scene_at_08()}) {
    for (const char* id : {"damping_anisotropy", "forcer_misalignment"}) {
      expect_signature(*s, {id, {{"gain", 50.0}}},
                       {{"rate_dph", [&](std::size_t i) { return 50.0 * s->nominal[i].drive_v; }}},
                       kAdiabatic);
    }
  }
}

TEST(EffectSignature, AnisotropyAndMisalignmentHaveTheirPhysicalSizes) {
  // 1 % of damping mismatch at 45 degrees: 0.90 d/tau; 1 mrad: 1.8 alpha/tau; tau = 719 s.
  const Instrument instrument = plain_instrument();
  World nominal(instrument, {}, Environment{}, 0);
  const double drive_v = 10.0 / 400.0 * (1.0 + 0.005 * std::cos(std::numbers::pi / 8.0));
  const double tau_s = 1.0 / nominal.parameters().damping_per_s;
  World turned(instrument, {{"damping_anisotropy", {{"gain", 100.0}}}}, Environment{}, 0);
  const double mismatch = turned.parameters().mismatch_sin_per_s - nominal.parameters().mismatch_sin_per_s;
  EXPECT_NEAR(mismatch / (2.0 * 0.554) / kRadPerSecondPerDph, 100.0 * drive_v, 1e-9);
  EXPECT_NEAR(tau_s, 719.0, 1.0);
  World skewed(instrument, {{"forcer_misalignment", {{"gain", 100.0}}}}, Environment{}, 0);
  const double alpha = skewed.parameters().forcer_misalignment_rad;
  EXPECT_NEAR(-alpha / (0.554 * tau_s) / kRadPerSecondPerDph, 100.0 * 10.0 / 400.0, 1e-9);
}

TEST(EffectSignature, FrequencySplit) {
  expect_signature(
      scene(),
      {"frequency_split",
       {{"span", 0.2}, {"temperature_low", -20.0}, {"temperature_high", 40.0}, {"per_hour", 0.03}}},
      {{"quadrature_v",
        [](std::size_t i) {
          const double u = (shell(scene(), i) - 10.0) / 30.0;
          return 0.2 * u * u + 0.03 * scene().inputs[i].time_s / 3600.0;
        }}},
      // the loop of 1 Hz settles to exp(-6.5) within a sample, the staircase of inputs has steps of 2e-3
      1e-5);
}

TEST(EffectSignature, DemodulationPhase) {
  for (const Scene* s : {&scene(), &scene_at_08()}) {
    expect_signature(*s, {"demodulation_phase", {{"gain", 6.0}, {"per_degc", 0.01}}},
                     {{"rate_dph",
                       [&](std::size_t i) {
                         return 6.0 * (1.0 + 0.01 * (board(*s, i) - 28.0)) * s->nominal[i].quadrature_v;
                       }}},
                     1e-9);
  }
}

TEST(EffectSignature, PickoffGain) {
  expect_signature(scene(), {"pickoff_gain", {{"per_degc", 1e-3}}},
                   {{"drive_v",
                     [](std::size_t i) {
                       const Scene& s = scene();
                       const double a = 1.0 / (1.0 + 1e-3 * (board(s, i) - 28.0));
                       // and what it takes to change the amplitude: tau A'
                       const double before = i == 0 ? a : 1.0 / (1.0 + 1e-3 * (board(s, i - 1) - 28.0));
                       const double tau_s = 1e7 / (std::numbers::pi * cubic_hz(20.0));
                       return s.nominal[i].drive_v * (a - 1.0) + 10.0 / 400.0 * tau_s * (a - before) / 10.0;
                     }},
                    {"rate_dph", [](std::size_t i) {
                       return scene().nominal[i].rate_dph *
                              (1.0 / (1.0 + 1e-3 * (board(scene(), i) - 28.0)) - 1.0);
                     }}});
}

/// True amplitude over the one that is measured: relative change of drive and rate alike.
std::map<std::string, Prediction> drive_and_rate_scale(const Scene& s, double relative) {
  return {{"drive_v", [&s, relative](std::size_t i) { return relative * s.nominal[i].drive_v; }},
          {"rate_dph", [&s, relative](std::size_t i) { return relative * s.nominal[i].rate_dph; }}};
}

TEST(EffectSignature, PickoffNonlinearity) {
  // A (1 + (3/4) c A^2) = 1: A = 1 - (3/4) c + 3 (3/4)^2 c^2 - 12 ((3/4) c)^3
  const double e = 0.75 * 2.0 * 0.02 * 0.02;
  expect_signature(scene(), {"pickoff_nonlinearity", {{"a2", 3.0}, {"a3", 2.0}, {"gap_ratio", 0.02}}},
                   drive_and_rate_scale(scene(), -e + 3.0 * e * e - 12.0 * e * e * e), 1e-6);
}

/// Amplitude whose wave has the fundamental 0.8 behind `convert`, by bisection on a sum over one period.
template <typename Convert>
double amplitude_behind(Convert convert) {
  constexpr int kPoints = 200000;
  double low = 0.7;
  double high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    double sum = 0.0;
    for (int k = 0; k < kPoints; ++k) {
      const double c = std::cos(std::numbers::pi * (k + 0.5) / kPoints);
      sum += convert(middle * c) * c;
    }
    (2.0 * sum / kPoints < 0.8 ? low : high) = middle;
  }
  return 0.5 * (low + high) / 0.8;
}

TEST(EffectSignature, AdcSaturation) {
  const double a = amplitude_behind([](double v) { return std::clamp(v, -0.78, 0.78); });
  EXPECT_GT(a, 1.001);
  expect_signature(scene(), {"adc_saturation", {{"level", 0.78}}}, drive_and_rate_scale(scene(), a - 1.0),
                   1e-6);
  // an amplitude of 0.64 does not reach the level
  const std::vector<TelemetrySample> small = scene_at_08().run({{"adc_saturation", {{"level", 0.78}}}});
  for (std::size_t i = 0; i < small.size(); ++i)
    EXPECT_EQ(small[i].drive_v, scene_at_08().nominal[i].drive_v);
}

TEST(EffectSignature, AdcNonlinearity) {
  constexpr double kPeakLsb = 20.0;
  const double a = amplitude_behind(
      [](double v) { return v + kPeakLsb / 32768.0 * integral_nonlinearity(0.5 + 0.5 * v); });
  // The sum misses each of 15 steps by up to a point of 2e5; each step is about the size of the peak.
  expect_signature(scene(), {"adc_nonlinearity", {{"peak", kPeakLsb}}},
                   drive_and_rate_scale(scene(), a - 1.0), 1e-3);
}

TEST(EffectSignature, AdcOffsetStaysOutOfTheTelemetry) {
  expect_signature(scene(), {"adc_offset", {}}, {});
  World world(Instrument{}, {{"adc_offset", {{"x", 30.0}, {"y", -7.0}}}}, Environment{}, 0);
  EXPECT_EQ(world.parameters().adc_offset_lsb[0], 30.0);
  EXPECT_EQ(world.parameters().adc_offset_lsb[1], -7.0);
}

TEST(EffectSignature, DriveFeedthrough) {
  // df = f tan(phi)/(2 Q), Q of the whole loss, tan(phi) = c d/0.8 with the command d = drive_v/10 V
  const auto tangent = [](std::size_t i) { return 2.0 * scene().nominal[i].drive_v / 10.0 / 0.8; };
  expect_signature(
      scene(), {"drive_feedthrough", {{"coupling", 2.0}}},
      {{"frequency_hz", [&](std::size_t i) { return cubic_hz(20.0) / (2.0 * 1e7) * tangent(i); }},
       {"drive_v", [&](std::size_t i) { return scene().nominal[i].drive_v * tangent(i) * tangent(i); }}},
      1e-4);
}

}  // namespace
}  // namespace hemi::physics

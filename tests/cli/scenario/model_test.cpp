// SPDX-License-Identifier: Apache-2.0
// The instrument and its nominal model say the same: what the slow run makes is what the model's equations
// predict.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cli/scenario/run.hpp"
#include "golden/calibration/frequency_polynomial.hpp"
#include "tests/cli/scenario/scenario_test.hpp"

namespace hemi::scenario::testing {
namespace {

using recording::InstrumentModel;

double polynomial(const std::vector<double>& c, double x) {
  double y = 0.0;
  for (auto k = c.rbegin(); k != c.rend(); ++k) y = y * x + *k;
  return y;
}

double bias_dph(const InstrumentModel& model, double frequency_hz, double df) {
  const double f = frequency_hz - model.bias->reference_hz;
  const double powers[10] = {1,      f,          f * f,      f * f * f, df, df * df, df * df * df,
                             f * df, f * f * df, f * df * df};
  double sum = 0.0;
  for (int i = 0; i < 10; ++i) sum += model.bias->terms_dph[static_cast<std::size_t>(i)] * powers[i];
  return sum;
}

constexpr const char* kDrifting = R"(
[scenario]
noise = false
[chamber]
profile = [["0 s", 20], ["10 min", 20], ["50 min", -20], ["2 h", -20]]
[instrument.bias]
"1" = 1.2
"f" = -0.62
"f^2" = 0.016
"df" = 850
"f*df" = 12
)";

class NominalModel : public ScenarioTest {
 protected:
  /// Resonator temperature by the model's f(T).
  static double degc(const InstrumentModel& model, double frequency_hz) {
    const auto& c = model.frequency->coefficients_hz;
    const calibration::FrequencyPolynomial f(Eigen::Map<const Eigen::VectorXd>(c.data(), std::ssize(c)),
                                             model.frequency->reference_degc, -40.0, 85.0);
    return f.temperature_degc(frequency_hz);
  }

  static void expect_same(const InstrumentModel& a, const InstrumentModel& b) {
    const auto same = [](const std::vector<double>& left, const std::vector<double>& right) {
      ASSERT_EQ(left.size(), right.size());
      for (std::size_t i = 0; i < left.size(); ++i)
        EXPECT_NEAR(left[i], right[i], 1e-12 * std::abs(right[i]) + 1e-15) << i;
    };
    same(a.frequency->coefficients_hz, b.frequency->coefficients_hz);
    same(a.drive->coefficients_v, b.drive->coefficients_v);
    same(a.quadrature->coefficients_v, b.quadrature->coefficients_v);
    for (std::size_t i = 0; i < 10; ++i)
      EXPECT_NEAR(a.bias->terms_dph[i], b.bias->terms_dph[i], 1e-9) << recording::kBiasTerms[i];
    EXPECT_EQ(a.thermal_time_constant_s, b.thermal_time_constant_s);
    EXPECT_EQ(a.scale_factor, b.scale_factor);
    EXPECT_EQ(a.amplitude_setpoint, b.amplitude_setpoint);
    EXPECT_NEAR(a.noise.at("rate_dph_rthz").white, b.noise.at("rate_dph_rthz").white, 1e-15);
  }
};

// d sin(2 th_tau) / (2 kappa) with d = 0.01 / 719 s and 2 th = 22.5 deg: 0.99 deg/h; drive 10 V / 400 and
// 0.46 % more; quadrature 10 V x 1 mHz sin(45 deg) / 50 mHz.
TEST_F(NominalModel, NumbersOfTheNominalInstrument) {
  const InstrumentModel model = read("[scenario]\nduration = 100\n").nominal_model();
  const double omega_20 = 2.0 * std::numbers::pi * polynomial(physics::Instrument{}.frequency_hz, 20.0);
  const double d_per_s = 0.01 * omega_20 / 2e7;
  const double sine = std::sin(std::numbers::pi / 8.0), cosine = std::cos(std::numbers::pi / 8.0);
  const double f_20 = polynomial(model.frequency->coefficients_hz, 20.0);
  EXPECT_NEAR(bias_dph(model, f_20, 0.0), d_per_s * sine / (2 * 0.554) * 180 / std::numbers::pi * 3600, 1e-4);
  EXPECT_NEAR(model.drive->coefficients_v[0], 10.0 / 400.0 * (1.0 + 0.005 * cosine), 1e-12);
  EXPECT_NEAR(model.quadrature->coefficients_v[0], 10.0 * 0.02 * std::numbers::sqrt2 / 2.0, 1e-12);
  EXPECT_NEAR(omega_20 / (2.0 * std::numbers::pi) - f_20, 0.5e-3 * std::numbers::sqrt2 / 2.0, 1e-9);
  EXPECT_EQ(model.thermal_time_constant_s, 2600.0);
}

// The damping does not depend on the temperature here, so that the model's cubic holds its bias exactly.
// Central differences over h = 1 s miss h^2/6 f''': below 15 Hz / (600 s 2600^2 s^2) / 6, times 850 deg/h per
// Hz/s: 5e-7 deg/h. Averaging over the second of a sample, f'' / 24 = 15 Hz / (600 s 2600 s) / 24, times 0.62
// deg/h/Hz: 3e-7 deg/h. The rebalance loop lags by 1 / (2 pi 40 Hz): 4 ms of a drift of at most 0.01 deg/h/s.
// Kinks of the chamber: none of f' itself.
TEST_F(NominalModel, PredictsTheRate) {
  const Scenario s = read(std::string(kDrifting) + "[instrument]\nrelative_damping = [1.0]\n");
  const InstrumentModel model = s.nominal_model();
  const auto telemetry = simulate_slow(s).telemetry;
  double largest = 0.0, rate_low = 1e9, rate_high = -1e9;
  for (std::size_t i = 1; i + 1 < telemetry.size(); ++i) {
    const double df = 0.5 * (telemetry[i + 1].frequency_hz - telemetry[i - 1].frequency_hz);
    largest =
        std::max(largest, std::abs(telemetry[i].rate_dph - bias_dph(model, telemetry[i].frequency_hz, df)));
    rate_low = std::min(rate_low, telemetry[i].rate_dph);
    rate_high = std::max(rate_high, telemetry[i].rate_dph);
  }
  EXPECT_LT(largest, 1e-3);
  EXPECT_GT(rate_high - rate_low, 5.0);
}

TEST_F(NominalModel, PredictsDriveAndQuadrature) {
  const Scenario s =
      read(std::string(kDrifting) + "[amplitude]\nsetpoint = 0.9\n[quadrature]\ntrim_v = 0.02\n");
  const InstrumentModel model = s.nominal_model();
  EXPECT_EQ(model.amplitude_setpoint, 0.9);
  const auto telemetry = simulate_slow(s).telemetry;
  // The drive's loop lags by 1 / (2 pi 0.5 Hz), the quadrature's by half of that: 0.3 s of 2e-3/degC x 0.02
  // degC/s.
  const double lag = 0.32 * 2e-3 * 0.02;
  // An oscillation that softens grows by itself, amplitude ~ f^-1/2: the drive feels f'/2f beside the
  // damping.
  const physics::Parameters p = s.instrument.at(20.0);
  for (std::size_t i = 60; i + 1 < telemetry.size(); i += 60) {
    const double df = 0.5 * (telemetry[i + 1].frequency_hz - telemetry[i - 1].frequency_hz);
    const double softening_v =
        0.9 * 0.5 * df / telemetry[i].frequency_hz / p.drive_per_s * s.instrument.drive_full_scale_v;
    const double from_20 = degc(model, telemetry[i].frequency_hz) - 20.0;
    const double drive_v = 0.9 * polynomial(model.drive->coefficients_v, from_20);
    const double quadrature_v = 0.9 * polynomial(model.quadrature->coefficients_v, from_20) + 0.02;
    EXPECT_NEAR(telemetry[i].drive_v, drive_v + softening_v, lag * drive_v) << i;
    EXPECT_NEAR(telemetry[i].quadrature_v, quadrature_v, lag * quadrature_v) << i;
  }
}

// The bias of the mismatch follows the damping, 0.2 % a degree; what its cubic in f misses is below 1 % of
// that change.
TEST_F(NominalModel, BiasFollowsTheDamping) {
  const InstrumentModel model = read("[chamber]\nprofile = [[0, -20], [100, 40]]\n").nominal_model();
  const double at_20 = bias_dph(model, polynomial(model.frequency->coefficients_hz, 20.0), 0.0);
  for (double t = -20.0; t <= 40.0; t += 5.0) {
    const double b = bias_dph(model, polynomial(model.frequency->coefficients_hz, t), 0.0);
    EXPECT_NEAR(b, at_20 * (1.0 + 0.002 * (t - 20.0)), 0.01 * at_20 * 0.002 * 40.0) << t;
  }
}

TEST_F(NominalModel, ComesBackAsAnInstrument) {
  const Scenario s =
      read(std::string(kDrifting) + "[instrument]\nquality_factor = 2e6\nsplit_axis_deg = 10\n");
  recording::write_model(path("a.model.json"), s.nominal_model());
  const Scenario again = read(
      "[scenario]\nduration = \"2 h\"\n[instrument]\nmodel = \"a.model.json\"\n"
      "[chamber]\nprofile = [[0, 20], [3000, -20]]\n");
  expect_same(again.nominal_model(), s.nominal_model());
  EXPECT_EQ(again.model_path, path("a.model.json"));
}

// A model with voltages and signs of its own, a scale factor and effects.
constexpr const char* kForeign = R"({"format": "hemi-model/1", "device": "HRG-A17",
  "frequency": {"reference_degc": 10.0, "coefficients_hz": [4428.5, 0.36, -5e-4, 1.4e-5]},
  "thermal": {"time_constant_s": 1700.0},
  "bias": {"reference_hz": 4432.0, "terms_dph": {"1": 2.0, "f": -0.31, "df": 850.0}},
  "scale_factor": 1.001,
  "drive": {"reference_degc": 0.0, "coefficients_v": [1.9, 0.004, 1e-5]},
  "quadrature": {"reference_degc": 20.0, "coefficients_v": [-0.8, 0.002]},
  "noise": {"rate_dph_rthz": {"white": 0.7, "flicker": 0.05}},
  "effects": [{"id": "thermal_hysteresis", "parameters": {"loop_height": {"value": 0.3, "unit": "deg/h"}}},
              {"id": "duffing", "parameters": {"relative_shift": 2e-7}}]})";

TEST_F(NominalModel, OfAForeignFile) {
  file("b.model.json", kForeign);
  const Scenario s =
      read("[scenario]\nduration = 100\n[table]\nrate_dph = 1000\n[instrument]\nmodel = \"b.model.json\"\n");
  EXPECT_EQ(s.device, "HRG-A17");
  const InstrumentModel given = recording::read_model(path("b.model.json"));
  const InstrumentModel model = s.nominal_model();
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(model.frequency->coefficients_hz[i], given.frequency->coefficients_hz[i], 1e-9);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(model.bias->terms_dph[i], given.bias->terms_dph[i], 1e-9);
  for (const double t : {-20.0, 0.0, 20.0, 40.0}) {
    EXPECT_NEAR(polynomial(model.drive->coefficients_v, t - 20.0), polynomial(given.drive->coefficients_v, t),
                1e-12);
    EXPECT_NEAR(polynomial(model.quadrature->coefficients_v, t - 20.0),
                polynomial(given.quadrature->coefficients_v, t - 20.0), 1e-12);
  }
  EXPECT_EQ(model.scale_factor, 1.001);
  EXPECT_NEAR(model.noise.at("rate_dph_rthz").flicker, 0.05, 1e-12);
  // The table's encoder tells 1000 deg/h, of which the instrument feels 1001.
  EXPECT_NEAR(s.inputs.at(0.0).rate_dph, 1001.0, 1e-9);
  const auto recording = to_recording(simulate_slow(s), s);
  EXPECT_NEAR(recording.find("rate_in_dph")->values[50], 1000.0, 1e-9);
  ASSERT_EQ(s.effects.size(), 2U);
  EXPECT_EQ(s.effects[0].id, "thermal_hysteresis");
  EXPECT_EQ(s.effects[0].values.at("loop_height"), 0.3);
  EXPECT_EQ(s.effects[1].values.at("relative_shift"), 2e-7);
}

TEST_F(NominalModel, BadFiles) {
  const std::string scenario =
      file("s.toml", "[scenario]\nduration = 100\n[instrument]\nmodel = \"b.model.json\"\n");
  const auto expect_bad = [&](std::string_view text, std::initializer_list<std::string_view> parts) {
    file("b.model.json", std::string("{\"format\": \"hemi-model/1\", ") + std::string(text) + "}");
    recording::testing::expect_input_error([&] { read_scenario(scenario); }, parts);
  };
  recording::testing::expect_input_error([&] { read_scenario(scenario); }, {"b.model.json", "No such file"});
  expect_bad(R"("drive": {"reference_degc": 20, "coefficients_v": [0]})",
             {"b.model.json: drive", "not above zero"});
  expect_bad(R"("quadrature": {"reference_degc": 20, "coefficients_v": [0, 1]})", {"quadrature", "is zero"});
  expect_bad(R"("bench": {"gain": 1, "damping_per_s": 1, "stiffness_per_s2": 1})", {"bench", "no gyro"});
  expect_bad(R"("effects": [{"name": "duffing"}])", {"b.model.json: effects", "without an id"});
  expect_bad(R"("effects": [{"id": "dufing"}])", {"b.model.json: effects", "did you mean 'duffing'"});
  expect_bad(R"("effects": [{"id": "duffing", "parameters": {"shift": 1}}])", {"'shift'", "relative_shift"});
}

}  // namespace
}  // namespace hemi::scenario::testing

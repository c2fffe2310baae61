// SPDX-License-Identifier: Apache-2.0
// Telemetry written from the recording format's equations by explicit Euler steps of a tenth of a sample; it
// shares nothing with the diagnosis but the types.
#ifndef HEMI_TESTS_GOLDEN_DIAGNOSIS_TELEMETRY_WRITER_HPP
#define HEMI_TESTS_GOLDEN_DIAGNOSIS_TELEMETRY_WRITER_HPP

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include "golden/diagnosis/telemetry.hpp"

namespace hemi::diagnosis::tests {

struct Recipe {
  std::uint64_t seed = 1;
  double duffing = 0.0;         ///< df/f of amplitude 0 to 1
  double leak_per_h = 0.0;      ///< relative growth of the drive
  double ripple_dph = 0.0;      ///< of the rate, one period each 4 degC: in no catalogue
  double hysteresis_dph = 0.0;  ///< Duhem: h' = (T' - |T'| h) / 6 degC
  double tau_scale = 1.0;       ///< of the model's time constant
  double wave_dph = 0.0;        ///< of the rate, one period each 6000 s: in no catalogue
  double warmth_degc = 0.0;     ///< final rise of the resonator while powered, time constant 1200 s
  double stem_degc = 0.0;       ///< of it as well, but as slowly as the resonator follows its case
  double strain_v = 0.0;        ///< of the quadrature: arctangent of (T - 18 degC) / 5 degC
  double loop_s = 0.0;          ///< time constant of the counted frequency
  double swing = 1.0;           ///< of the case; 0: stands still
  double start_degc = 0.0;      ///< of the resonator, above the case
  Eigen::Index cut_rows = 0;    ///< power is off for these rows, from the 8000th
};

inline NominalModel nominal() {
  NominalModel model;
  model.frequency_hz = {0.0, {4424.9, 0.3716, -9.7e-4, 1.53e-5}};
  model.time_constant_s = 1900.0;
  model.bias_reference_hz = 4432.0;
  model.bias_dph = {1.5, 0.2, -0.004, 0.0, 400.0};
  model.drive_v = {20.0, {2.0, 0.004}};
  model.quadrature_v = {20.0, {0.8, 0.002}};
  return model;
}

/// Five hours at 1 Hz: up and down twice, amplitude steps every half hour.
inline Telemetry telemetry(const Recipe& recipe) {
  constexpr Eigen::Index kRows = 18000;
  constexpr int kSteps = 10;
  const NominalModel m = nominal();
  std::mt19937_64 random(recipe.seed);
  std::normal_distribution<double> normal;
  const auto at_case = [&](double t) {
    return 15.0 + recipe.swing * (25.0 * std::sin(2.0 * std::numbers::pi * t / 9000.0) +
                                  8.0 * std::sin(2.0 * std::numbers::pi * t / 5200.0));
  };
  const auto polynomial = [](const Polynomial& p, double x) {
    double sum = 0.0;
    for (auto c = p.coefficients.rbegin(); c != p.coefficients.rend(); ++c)
      sum = sum * (x - p.reference) + *c;
    return sum;
  };
  Telemetry t;
  t.step_s = 1.0;
  t.has_board = t.has_accel = t.has_supply = false;
  for (auto* x :
       {&t.case_degc, &t.board_degc, &t.rate_in_dph, &t.accel_g, &t.supply_v, &t.trim_v, &t.amplitude})
    *x = Eigen::VectorXd::Zero(kRows);
  for (auto& output : t.outputs) output = Eigen::VectorXd::Zero(kRows);
  t.powered = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(kRows, true);
  const double tau = m.time_constant_s * recipe.tau_scale;
  double degc = at_case(0.0) + recipe.start_degc, before = degc, loop = 0.0, heat = 0.0, stem = 0.0,
         behind_case = degc;
  const auto powered = [&](Eigen::Index i) { return i < 8000 || i >= 8000 + recipe.cut_rows; };
  double frequency_before = polynomial(m.frequency_hz, degc), counted = 0.0;
  for (Eigen::Index i = 0; i < kRows; ++i) {
    for (int k = 0; k < kSteps && i > 0; ++k) {
      behind_case +=
          (at_case(static_cast<double>(i - 1) + (k + 0.5) / kSteps) - behind_case) / (tau * kSteps);
      heat += ((powered(i - 1) ? recipe.warmth_degc : 0.0) - heat) / (1200.0 * kSteps);
      stem += ((powered(i - 1) ? recipe.stem_degc : 0.0) - stem) / (tau * kSteps);
    }
    degc = behind_case + heat + stem;
    const double step = (degc - before) / 6.0;
    loop += step - std::abs(step) * loop;
    before = degc;
    const double time = static_cast<double>(i);
    const double amplitude = 1.0 + 0.1 * (static_cast<int>(time / 1800.0) % 3 - 1);
    const double frequency = polynomial(m.frequency_hz, degc);
    const double f = frequency - m.bias_reference_hz, df = frequency - frequency_before;
    frequency_before = frequency;
    t.case_degc[i] = std::round((at_case(time) + 0.008 * normal(random)) * 100.0) / 100.0;
    t.amplitude[i] = amplitude;
    counted +=
        (i == 0 || recipe.loop_s == 0.0 ? 1.0 : -std::expm1(-1.0 / recipe.loop_s)) * (frequency - counted);
    t.outputs[place(Output::frequency)][i] =
        counted * (1.0 + recipe.duffing * (amplitude * amplitude - 1.0)) + 3e-5 * normal(random);
    t.outputs[place(Output::drive)][i] =
        amplitude * polynomial(m.drive_v, degc) * (1.0 + recipe.leak_per_h * time / 3600.0) +
        1.4e-4 * normal(random);
    t.outputs[place(Output::quadrature)][i] =
        amplitude * (polynomial(m.quadrature_v, degc) + recipe.strain_v * std::atan((degc - 18.0) / 5.0)) +
        1.4e-4 * normal(random);
    t.outputs[place(Output::rate)][i] =
        m.bias_dph[0] + m.bias_dph[1] * f + m.bias_dph[2] * f * f + m.bias_dph[4] * df +
        recipe.hysteresis_dph * loop + recipe.ripple_dph * std::sin(2.0 * std::numbers::pi * degc / 4.0) +
        recipe.wave_dph * std::sin(2.0 * std::numbers::pi * time / 6000.0) + 0.5 * normal(random);
  }
  if (recipe.cut_rows > 0) {
    t.powered.segment(8000, recipe.cut_rows) = false;
    for (auto& output : t.outputs)
      output.segment(8000, recipe.cut_rows).setConstant(std::numeric_limits<double>::quiet_NaN());
    // A straight line, as a reader fills in what was not recorded.
    t.case_degc.segment(8000, recipe.cut_rows) =
        Eigen::VectorXd::LinSpaced(recipe.cut_rows, t.case_degc[7999], t.case_degc[8000 + recipe.cut_rows]);
  }
  return t;
}

}  // namespace hemi::diagnosis::tests

#endif  // HEMI_TESTS_GOLDEN_DIAGNOSIS_TELEMETRY_WRITER_HPP

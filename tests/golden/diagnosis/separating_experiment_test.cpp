// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/separating_experiment.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>

#include "tests/golden/diagnosis/telemetry_writer.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;

// What an effect adds to a run, written from its physics by steps of a second; no code of the diagnosis.
// The third argument is the true frequency, which the bias follows.
using Effect = std::function<void(Telemetry&, const VectorXd& resonator_degc, VectorXd& true_hz)>;

double value(const Polynomial& p, double x) {
  double sum = 0.0;
  for (auto c = p.coefficients.rbegin(); c != p.coefficients.rend(); ++c) sum = sum * (x - p.reference) + *c;
  return sum;
}

// Outputs for inputs every second: the format's equations, the effect, noise; thermometers read in steps.
Telemetry carried_out(Telemetry t, const Effect& effect, std::uint64_t seed) {
  const NominalModel m = tests::nominal();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Index n = t.rows();
  VectorXd degc(n), f(n);
  for (Index i = 0; i < n; ++i) {
    degc[i] =
        i == 0 ? t.case_degc[0] : degc[i - 1] + (t.case_degc[i] - degc[i - 1]) / (m.time_constant_s + 0.5);
    f[i] = value(m.frequency_hz, degc[i]) - m.bias_reference_hz;
  }
  for (auto& output : t.outputs) output = VectorXd::Zero(n);
  effect(t, degc, f);
  VectorXd df = VectorXd::Zero(n);
  df.tail(n - 1) = f.tail(n - 1) - f.head(n - 1);
  for (Index i = 0; i < n; ++i) {
    t.outputs[place(Output::frequency)][i] += f[i] + m.bias_reference_hz + 3e-5 * normal(random);
    t.outputs[place(Output::drive)][i] +=
        t.amplitude[i] * value(m.drive_v, degc[i]) + 1.4e-4 * normal(random);
    t.outputs[place(Output::quadrature)][i] +=
        t.amplitude[i] * value(m.quadrature_v, degc[i]) + t.trim_v[i] + 1.4e-4 * normal(random);
    t.outputs[place(Output::rate)][i] += t.rate_in_dph[i] + m.bias_dph[0] + m.bias_dph[1] * f[i] +
                                         m.bias_dph[2] * f[i] * f[i] + m.bias_dph[4] * df[i] +
                                         0.5 * normal(random);
    t.case_degc[i] = std::round((t.case_degc[i] + 0.005 * normal(random)) * 100.0) / 100.0;
  }
  return t;
}

Effect gradient(double gain_dph) {
  return [=](Telemetry& t, const VectorXd&, VectorXd&) {
    double node = t.case_degc[0];
    for (Index i = 0; i < t.rows(); ++i) {
      node += (t.case_degc[i] - node) / 300.0;
      t.outputs[place(Output::rate)][i] += gain_dph * (t.case_degc[i] - node);
    }
  };
}

Effect play(double dph_per_degc, double radius_degc) {
  return [=](Telemetry& t, const VectorXd& degc, VectorXd&) {
    double state = degc[0];
    for (Index i = 0; i < t.rows(); ++i) {
      state = std::clamp(state, degc[i] - radius_degc, degc[i] + radius_degc);
      t.outputs[place(Output::rate)][i] += dph_per_degc * (state - degc[i]);
    }
  };
}

Effect quartic(double a4) {
  return [=](Telemetry&, const VectorXd& degc, VectorXd& true_hz) {
    true_hz.array() += a4 * degc.array().pow(4);
  };
}

Effect clock_cubic(double ppm) {
  return [=](Telemetry& t, const VectorXd&, VectorXd&) {
    t.outputs[place(Output::frequency)].array() -=
        4430e-6 * ppm * ((t.board_degc.array() - 25.0) / 30.0).cube();
  };
}

Effect ageing(double hz_per_h) {
  return [=](Telemetry& t, const VectorXd&, VectorXd& true_hz) {
    true_hz.array() +=
        ArrayXd::LinSpaced(t.rows(), 0.0, hz_per_h * static_cast<double>(t.rows() - 1) / 3600.0);
  };
}

// Loss that grows with the square of the vibration: the drive holds the amplitude against it.
Effect loss_with_amplitude(double relative) {
  return [=](Telemetry& t, const VectorXd& degc, VectorXd&) {
    for (Index i = 0; i < t.rows(); ++i)
      t.outputs[place(Output::drive)][i] += t.amplitude[i] * value(tests::nominal().drive_v, degc[i]) *
                                            relative * (t.amplitude[i] * t.amplitude[i] - 1.0);
  };
}

// Loss beyond the model's line in temperature.
Effect loss_with_temperature(double v) {
  return [=](Telemetry& t, const VectorXd& degc, VectorXd&) {
    t.outputs[place(Output::drive)].array() +=
        v * t.amplitude.array() * ((degc.array() - 10.0) / 30.0).square();
  };
}

Effect scale_cubic(double dph_at_full_rate) {
  return [=](Telemetry& t, const VectorXd&, VectorXd&) {
    t.outputs[place(Output::rate)].array() += dph_at_full_rate * (t.rate_in_dph.array() / 1e5).cube();
  };
}

Effect quadrature_into_rate(double dph_per_v) {
  return [=](Telemetry& t, const VectorXd& degc, VectorXd&) {
    for (Index i = 0; i < t.rows(); ++i)
      t.outputs[place(Output::rate)][i] +=
          dph_per_v * (t.amplitude[i] * value(tests::nominal().quadrature_v, degc[i]) + t.trim_v[i]);
  };
}

Stand stand() {
  Stand s;
  s.low_degc = -20.0;
  s.high_degc = 40.0;
  s.start_degc = 22.0;
  return s;
}

Experiment program(std::vector<Corner> chamber, double hours) {
  Experiment e;
  e.chamber_degc = std::move(chamber);
  e.duration_s = 3600.0 * hours;
  return e;
}

Experiment cycles() {
  return program({{0.0, 22.0}, {4000.0, 40.0}, {10000.0, -20.0}, {16000.0, 40.0}, {21000.0, 0.0}}, 6.0);
}

// The diagnosis's own choice with its rivals from `set`, whatever their gaps: what is asked here is which
// experiment separates them, not whether this recording does.
TelemetryDiagnosis ambiguous(TelemetryDiagnosis d, const std::vector<std::string>& set) {
  std::vector<Explanation> all = d.named;
  all.insert(all.end(), d.ambiguous.begin(), d.ambiguous.end());
  d.named.clear();
  d.ambiguous.clear();
  for (auto& entry : all) {
    if (!d.ambiguous.empty() || std::ranges::find(set, entry.effect) == set.end()) continue;
    entry.near.clear();
    for (const auto& id : set)
      if (id != entry.effect) entry.near.emplace_back(id, 1.0);
    d.ambiguous.push_back(entry);
  }
  if (d.ambiguous.empty()) ADD_FAILURE() << "found " << (all.empty() ? "nothing" : all[0].effect);
  d.verdict = Verdict::ambiguous;
  return d;
}

void expect_resolved(const SeparatingExperiment& found, const Effect& effect, const std::string& truth) {
  const auto inputs = inputs_of(found.experiment.value(), found.stand, 1.0);
  const auto again = diagnose_telemetry(carried_out(inputs, effect, 77), tests::nominal());
  EXPECT_EQ(again.verdict, Verdict::named) << truth << ", " << found.experiment->in_words();
  ASSERT_EQ(again.named.size(), 1U) << truth << ", " << found.experiment->in_words();
  EXPECT_EQ(again.named[0].effect, truth) << found.experiment->in_words();
}

// Speeds of the chamber in degC/min, without sign, a hold as 0.
std::set<double> speeds(const Experiment& experiment) {
  std::set<double> all;
  for (std::size_t i = 1; i < experiment.chamber_degc.size(); ++i) {
    const auto &from = experiment.chamber_degc[i - 1], &to = experiment.chamber_degc[i];
    all.insert(std::round(600.0 * std::abs((to.value - from.value) / (to.time_s - from.time_s))) / 10.0);
  }
  return all;
}

// Over cycles of one speed a lag and a memory of the direction are both an open loop.
TEST(SeparatingExperiment, LagAndHysteresisAreToldBySeveralSpeeds) {
  const std::vector<std::string> set = {"thermal_gradient_bias", "thermal_hysteresis"};
  const auto run = inputs_of(cycles(), stand(), 1.0);
  const auto d = ambiguous(diagnose_telemetry(carried_out(run, gradient(2.0), 5), tests::nominal()), set);
  ASSERT_EQ(d.ambiguous.size(), 1U);
  const auto found = find_separating_experiment(d, tests::nominal());
  ASSERT_TRUE(found && found->experiment);
  EXPECT_TRUE(found->inseparable.empty());
  EXPECT_LE(found->experiment->duration_s, 36000.0);
  EXPECT_GE(speeds(*found->experiment).size(), 2U) << found->experiment->in_words();
  EXPECT_GT(found->gaps.at(0).gap, kNameMargin);
  expect_resolved(*found, gradient(2.0), "thermal_gradient_bias");
  expect_resolved(*found, play(0.3, 4.0), "thermal_hysteresis");
}

// The amplitude followed the resonator's temperature: what the loss follows cannot be said.
TEST(SeparatingExperiment, LossesByAmplitudeAndByTemperatureAreToldByAmplitudeSteps) {
  const std::vector<std::string> set = {"damping_nonlinearity", "damping_temperature"};
  auto run = inputs_of(cycles(), stand(), 1.0);
  double degc = run.case_degc[0];
  for (Index i = 0; i < run.rows(); ++i) {
    degc += (run.case_degc[i] - degc) / tests::nominal().time_constant_s;
    run.amplitude[i] = 1.0 + 0.1 * std::pow((degc - 10.0) / 30.0, 2);
  }
  const auto recording = carried_out(run, loss_with_amplitude(5e-3), 8);
  const auto d = ambiguous(diagnose_telemetry(recording, tests::nominal()), set);
  ASSERT_EQ(d.ambiguous.size(), 1U);
  const auto found = find_separating_experiment(d, tests::nominal());
  ASSERT_TRUE(found && found->experiment);
  EXPECT_TRUE(found->experiment->steps.contains(Stimulus::amplitude)) << found->experiment->in_words();
  EXPECT_GT(found->experiment->chamber_degc.size(), 2U) << found->experiment->in_words();
  expect_resolved(*found, loss_with_amplitude(5e-3), "damping_nonlinearity");
  expect_resolved(*found, loss_with_temperature(2e-3), "damping_temperature");
}

// The quadrature was offset whenever the table turned, in step with the cube of the rate.
TEST(SeparatingExperiment, ScaleFactorAndBiasAreToldByTurningWithoutThem) {
  const std::vector<std::string> set = {"scale_factor_nonlinearity", "demodulation_phase"};
  auto run = inputs_of(with_stimuli(cycles(), {Stimulus::rate}, stand()), stand(), 1.0);
  run.trim_v = 0.3 * (run.rate_in_dph.array() / 108e3).cube();
  const auto d = ambiguous(diagnose_telemetry(carried_out(run, scale_cubic(1.0), 9), tests::nominal()), set);
  ASSERT_EQ(d.ambiguous.size(), 1U);
  const auto found = find_separating_experiment(d, tests::nominal());
  ASSERT_TRUE(found && found->experiment);
  EXPECT_TRUE(found->experiment->steps.contains(Stimulus::rate)) << found->experiment->in_words();
  EXPECT_TRUE(found->experiment->steps.contains(Stimulus::trim)) << found->experiment->in_words();
  expect_resolved(*found, scale_cubic(1.0), "scale_factor_nonlinearity");
  expect_resolved(*found, quadrature_into_rate(3.0), "demodulation_phase");
}

TEST(SeparatingExperiment, ABoardThatFollowsTheResonatorIsHeated) {
  const std::vector<std::string> set = {"frequency_polynomial_order", "oscillator_temperature"};
  Stand like_resonator = stand();
  like_resonator.board_lag_s = 1.01 * tests::nominal().time_constant_s;
  const auto run = inputs_of(cycles(), like_resonator, 1.0);
  const auto d = ambiguous(diagnose_telemetry(carried_out(run, quartic(-1e-7), 6), tests::nominal()), set);
  ASSERT_EQ(d.ambiguous.size(), 1U);
  const auto found = find_separating_experiment(d, tests::nominal());
  ASSERT_TRUE(found && found->experiment);
  EXPECT_NEAR(found->stand.board_lag_s, like_resonator.board_lag_s, 0.02 * like_resonator.board_lag_s);
  EXPECT_TRUE(found->experiment->steps.contains(Stimulus::board_heater)) << found->experiment->in_words();
  expect_resolved(*found, quartic(-1e-7), "frequency_polynomial_order");
  expect_resolved(*found, clock_cubic(1.0), "oscillator_temperature");
}

TEST(SeparatingExperiment, TwoAgeingsAreSaidInseparable) {
  const auto run = inputs_of(cycles(), stand(), 1.0);
  const auto d = ambiguous(diagnose_telemetry(carried_out(run, ageing(1e-3), 7), tests::nominal()),
                           {"frequency_ageing", "oscillator_ageing"});
  ASSERT_EQ(d.ambiguous.size(), 1U);
  const auto found = find_separating_experiment(d, tests::nominal());
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->experiment);
  ASSERT_EQ(found->inseparable.size(), 1U);
  EXPECT_LT(found->inseparable[0].gap, kNameMargin);
}

// Where forms are exact, 99 of 100 runs leave the margin for a name: the estimated strength scatters by one
// standard deviation, which is the root of the gap.
TEST(SeparatingExperiment, AnEnoughGapLeavesTheMarginInNinetyNineOfAHundredRuns) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const double root = std::sqrt(0.5 * enough_gap());
  constexpr int kRuns = 100000;
  int named = 0;
  for (int i = 0; i < kRuns; ++i)
    // Score of the truth over the rival's, whose trace differs by `root` deviations of the noise.
    if (root * root + 2.0 * root * normal(random) > kNameMargin) ++named;
  // Three standard deviations of a share of 0.99.
  EXPECT_NEAR(static_cast<double>(named) / kRuns, 0.99, 3.0 * std::sqrt(0.99 * 0.01 / kRuns));
}

TEST(SeparatingExperiment, GapsGrowWithTheSquareOfTheStrengthAndVanishForWhatARunCannotShow) {
  const auto run = inputs_of(cycles(), stand(), 1.0);
  auto d = ambiguous(diagnose_telemetry(carried_out(run, gradient(2.0), 5), tests::nominal()),
                     {"thermal_gradient_bias", "thermal_hysteresis"});
  ASSERT_EQ(d.ambiguous.size(), 1U);
  auto sets = alternative_sets(d);
  ASSERT_EQ(sets.size(), 1U);
  const auto detected = [&](const Experiment& experiment) {
    for (const auto& gap : expected_gaps(experiment, stand(), tests::nominal(), d, sets))
      if (gap.truth == sets[0].alternatives[0].effect && gap.rival.empty()) return gap.gap;
    return -1.0;
  };
  // Known beyond doubt, so that nothing is taken off for its standard error; price 21 of one coefficient and
  // one shape.
  sets[0].alternatives.resize(1);
  sets[0].alternatives[0].deviations = 1e9;
  const double once = detected(cycles());
  for (double& c : sets[0].alternatives[0].coefficients) c *= 2.0;
  EXPECT_NEAR((detected(cycles()) + 21.0) / (once + 21.0), 4.0, 1e-6);
  EXPECT_LE(detected(program({{0.0, 22.0}}, 6.0)), 0.0);
}

}  // namespace
}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/effects.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <complex>
#include <numbers>
#include <set>
#include <unsupported/Eigen/FFT>

#include "golden/concealed/draw.hpp"
#include "golden/concealed/noise.hpp"

namespace hemi::concealed {
namespace {

const std::map<std::string, int> kOutputOf{
    {"frequency_hz", kFrequency}, {"drive_v", kDrive}, {"quadrature_v", kQuadrature}, {"rate_dph", kRate}};

/// Energy of a trace over the white noise, by channel.
std::array<double, kOutputs> energies(const Trace& trace, const Instrument& unit) {
  std::array<double, kOutputs> energy{};
  for (int output = 0; output < kOutputs; ++output)
    energy[output] = trace[output].square().sum() / std::pow(unit.noise[output].white, 2);
  return energy;
}

class EveryKind : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryKind, ShowsWhereTheCatalogueSaysAndVanishesWithItsStrength) {
  const Kind& one = kind(GetParam());
  for (std::uint64_t draw = 0; draw < 2; ++draw) {
    Random random(3, one.id, draw);
    const Stand stand = random_stand(random, "multispeed", one.needs);
    const Form form = one.draw({random, stand.in, stand.unit.model, stand.baseline});
    const double offset = stand.unit.nuisance.start_offset_degc;
    const auto trace_at = [&](double strength) {
      return trace_of(simulate(stand.unit.model, stand.in, offset, {form.at(form.sign * strength)}),
                      stand.baseline, stand.unit.model, stand.in, offset);
    };
    if (form.dprime) {  // acts on the written rows
      EXPECT_GT(form.dprime(form.high), 50.0);
      continue;
    }
    const auto full = energies(trace_at(form.high), stand.unit);
    const double sum = full[0] + full[1] + full[2] + full[3];
    EXPECT_GT(sum, 25.0) << one.id << " " << form.name << " is nowhere to be seen";
    if (!one.channel.empty()) {
      EXPECT_GT(full[kOutputOf.at(one.channel)], 0.5 * sum) << one.id << " " << form.name;
    }
    if (!form.scalable) continue;
    const auto small = energies(trace_at(1e-3 * form.high + form.low), stand.unit);
    EXPECT_LT(small[0] + small[1] + small[2] + small[3], 0.1 * sum) << one.id << " " << form.name;
  }
}

std::vector<std::string> all_ids() {
  std::vector<std::string> ids;
  for (const Kind& one : catalogue_kinds()) ids.push_back(one.id);
  for (const Kind& one : unknown_kinds()) ids.push_back(one.id);
  return ids;
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind, ::testing::ValuesIn(all_ids()),
                         [](const auto& of) { return of.param; });

TEST(Kinds, HaveNamesOfTheirOwn) {
  const auto ids = all_ids();
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
  EXPECT_THROW(kind("phlogiston"), std::out_of_range);
}

TEST(Drift, HasTheSpectrumThatItCountsWithAsNoiseToOthers) {
  for (const char* id : {"rate_random_walk", "rate_flicker"}) {
    Random random(11, id, 0);
    const Stand stand = random_stand(random, "multispeed", 0);
    const Form form = kind(id).draw({random, stand.in, stand.unit.model, stand.baseline});
    const double offset = stand.unit.nuisance.start_offset_degc;
    const Series drift =
        simulate(stand.unit.model, stand.in, offset, {form.at(1.0)}).rate_dph - stand.baseline.rate_dph;
    // Of steps: a drift itself ends elsewhere than it began, and that leaks into every line.
    const auto n = static_cast<Eigen::Index>(std::bit_floor(static_cast<std::size_t>(drift.size() - 1)));
    const Eigen::VectorXcd steps =
        (drift.segment(1, n) - drift.head(n)).matrix().cast<std::complex<double>>();
    Eigen::VectorXcd lines(n);
    Eigen::FFT<double>().fwd(lines, steps);
    double sum = 0.0;
    const Eigen::Index from = 10, to = n / 20;
    for (Eigen::Index k = from; k < to; ++k) {
      const double f = static_cast<double>(k) / static_cast<double>(n);
      const double expected = density(form.noise, f) * std::pow(2.0 * std::sin(std::numbers::pi * f), 2);
      sum += std::norm(lines[k]) * 2.0 / static_cast<double>(n) / expected;
    }
    // A line's power over its density is exponential: deviation 1.
    const auto count = static_cast<double>(to - from);
    EXPECT_NEAR(sum / count, 1.0, 5.0 / std::sqrt(count)) << id;
  }
}

TEST(Drift, IsNoiseToWhatElseMovesTheRate) {
  Random random(12);
  const Stand stand = random_stand(random, "cycle", 0);
  Trace slow;
  for (Series& series : slow) series = Series::Zero(stand.in.time_s.size());
  slow[kRate] = (stand.in.time_s / 700.0).sin();
  const auto beside = [&](double random_walk) {
    NoiseLevel more;
    more.random_walk = random_walk;
    return detectability_in(stand, more).dprime(slow);
  };
  EXPECT_LT(beside(0.01), 0.99 * detectability(stand).dprime(slow));
  // Where the walk is all of the noise d' falls as its density rises.
  EXPECT_NEAR(beside(100.0) / beside(200.0), 2.0, 0.01);
}

TEST(OscillatorTemperature, MovesTheCountedFrequencyAlone) {
  Random random(4);
  const Stand stand = random_stand(random, "cycle", kBoardLoad);
  const Form form = kind("oscillator_temperature").draw({random, stand.in, stand.unit.model, stand.baseline});
  const State with = simulate(stand.unit.model, stand.in, 0.0, {form.at(3.0)});
  const State without = simulate(stand.unit.model, stand.in, 0.0);
  EXPECT_TRUE((with.rate_dph == without.rate_dph).all());
  EXPECT_TRUE((with.drive_v == without.drive_v).all());
  const Series ppm = (with.frequency_hz / without.frequency_hz - 1.0) * 1e6;
  EXPECT_NEAR(ppm.maxCoeff() - ppm.minCoeff(), 3.0, 1e-3);
}

TEST(SelfHeating, IsFeltByAllThatFollowsTheShell) {
  Random random(4);
  const Stand stand = random_stand(random, "constant", 0);
  const Form form = kind("self_heating").draw({random, stand.in, stand.unit.model, stand.baseline});
  const State with = simulate(stand.unit.model, stand.in, 0.0, {form.at(1.5)});
  const State without = simulate(stand.unit.model, stand.in, 0.0);
  const Eigen::Index last = with.rate_dph.size() - 1;
  // After hours at a constant case the shell is 1.5 degC warmer (five time constants and more: 0.7 %).
  EXPECT_NEAR(with.shell_degc[last] - without.shell_degc[last], 1.5, 0.015);
  const Series t = without.shell_degc.tail(1) + 1.5;
  EXPECT_NEAR(with.frequency_hz[last], polynomial(stand.unit.model.frequency_hz, t)[0], 0.01);
  EXPECT_NEAR(with.drive_v[last], polynomial(stand.unit.model.drive_v, t - 20.0)[0], 1e-4);
  EXPECT_NE(with.rate_dph[last], without.rate_dph[last]);
}

TEST(PickoffGain, ScalesTheRateWithTheDrive) {
  Random random(9);
  const Stand stand = random_stand(random, "cycle", kTurn);
  const Form form = kind("pickoff_gain").draw({random, stand.in, stand.unit.model, stand.baseline});
  const State with = simulate(stand.unit.model, stand.in, 0.0, {form.at(1e-4)});
  const State without = simulate(stand.unit.model, stand.in, 0.0);
  const Series drive = with.drive_v / without.drive_v, rate = with.rate_dph / without.rate_dph;
  EXPECT_LT((drive - rate).abs().maxCoeff(), 1e-12);
  EXPECT_LT((drive * (1.0 + 1e-4 * (stand.in.board_degc - 25.0)) - 1.0).abs().maxCoeff(), 1e-12);
}

/// Forms that are sized by a run's ranges.
class SizedKind : public ::testing::TestWithParam<std::string> {};

TEST_P(SizedKind, IsTheSameInstrumentInAnotherRun) {
  // Half of a run as a run of its own: what the effect does in it is what it did in that half.
  const Kind& one = kind(GetParam());
  for (std::uint64_t draw = 0; draw < 6; ++draw) {
    Random random(5, one.id, draw);
    const Stand whole = random_stand(random, "multispeed", 0);
    const Eigen::Index rows = whole.in.time_s.size() / 2;
    Excitation in = whole.in;
    for (Series* series : {&in.time_s, &in.case_degc, &in.case_ahead_degc, &in.board_degc, &in.rate_in_dph,
                           &in.accel_g, &in.supply_v, &in.trim_v, &in.amplitude, &in.power})
      *series = Series(series->head(rows));
    const Model& model = whole.unit.model;
    const double offset = whole.unit.nuisance.start_offset_degc;
    const State baseline = simulate(model, in, offset);
    Random again = random;
    const Setting first{random, whole.in, model, whole.baseline};
    const Form there = one.draw(first), here = one.draw({again, in, model, baseline, &first});
    const State a = simulate(model, whole.in, offset, {there.at(there.high)});
    const State b = simulate(model, in, offset, {here.at(here.high)});
    for (int output = 0; output < kOutputs; ++output) {
      const Series effect = a.output(output) - whole.baseline.output(output);
      // Slopes have one neighbour less at the end of a run.
      const Series difference = (a.output(output).head(rows) - b.output(output)).head(rows - 2);
      EXPECT_LE(difference.abs().maxCoeff(),
                1e-9 * (effect.abs().maxCoeff() + a.output(output).abs().maxCoeff()))
          << one.id << " " << there.name << " " << output;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, SizedKind,
                         ::testing::Values("thermal_hysteresis", "oscillator_temperature", "frequency_ageing",
                                           "damping_temperature", "frequency_split"));

}  // namespace
}  // namespace hemi::concealed

// SPDX-License-Identifier: Apache-2.0
// Lines, stochastic drift, and what goes wrong between the core and the file.
#include <cmath>
#include <numbers>

#include "golden/concealed/effects.hpp"
#include "golden/concealed/noise.hpp"

namespace hemi::concealed {
namespace {

Form added(const std::string& name, Stage stage, int output, const Series& shape, double high,
           std::function<Values(double)> parameters) {
  Form form;
  form.name = name;
  form.high = high;
  form.at = [=](double strength) { return adding(stage, output, shape, strength); };
  form.parameters = std::move(parameters);
  return form;
}

Form interference(const Setting& in) {
  const double line_hz = in.random.uniform(0.02, 0.47);
  const double beat = in.random.chance(0.4) ? in.random.uniform(0.05, 0.25) : 0.0;
  const Series& t = in.in.time_s;
  const Series swell = 1.0 + beat * (kTurn_rad * t / in.random.uniform(3000.0, 9000.0)).sin();
  const Series line = swell * (kTurn_rad * line_hz * t + in.random.uniform(0.0, kTurn_rad)).sin();
  const bool on_rate = in.random.chance(0.7);
  return added(beat > 0.0 ? "swelling line" : "steady line", Stage::kOutput, on_rate ? kRate : kFrequency,
               line, on_rate ? 2.0 : 2e-3, [line_hz](double amplitude) {
                 return Values{{"amplitude", amplitude}, {"frequency", line_hz}};
               });
}

/// The carrier's multiple as one-second samples see it: the fold is done by sampling its phase.
Form aliased_carrier(const Setting& in) {
  const double multiple = in.random.chance(0.5) ? 1.0 : 2.0;
  const Series& f = in.baseline.frequency_hz;
  Series phase_turns(f.size());
  double turns = in.random.uniform(0.0, 1.0);
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    turns = std::fmod(turns + multiple * f[i], 1.0);
    phase_turns[i] = turns;
  }
  const double folded = std::abs(std::remainder(multiple * f[0], 1.0));
  const bool on_rate = in.random.chance(0.7);
  return added(multiple == 1.0 ? "carrier" : "twice the carrier", Stage::kOutput,
               on_rate ? kRate : kFrequency, (kTurn_rad * phase_turns).sin(), on_rate ? 2.0 : 2e-3,
               [folded](double amplitude) {
                 return Values{{"amplitude", amplitude}, {"frequency", folded}};
               });
}

Form rate_flicker(const Setting& in) {
  NoiseLevel level;
  level.flicker = 1.0;
  const Series drift = noise(level, in.in.time_s.size(), in.random);
  const Series centred = drift - drift.mean();
  const double deviation = std::sqrt(centred.square().mean());
  Form form = added("shaped spectrum", Stage::kRate, kRate, centred / deviation, 2.0, [](double size) {
    return Values{{"density", size}};
  });
  form.noise.flicker = level.flicker / deviation;
  return form;
}

Form rate_random_walk(const Setting& in) {
  Series walk(in.in.time_s.size());
  double at = 0.0;
  for (double& value : walk) value = at += in.random.normal();
  Form form = added("summed steps", Stage::kRate, kRate, walk, 0.2, [](double density) {
    return Values{{"density", density}};
  });
  // One-sided density of steps of variance 1 a second: 2 / (2 pi f)^2.
  form.noise.random_walk = std::numbers::sqrt2 / kTurn_rad;
  return form;
}

/// Rows whose outputs repeat the row before, noise and all; the time stamps run on.
Form sample_loss(const Setting& in) {
  Form form;
  form.name = "the last record again";
  const auto rows = static_cast<std::size_t>(in.in.time_s.size());
  std::vector<Eigen::Index> order;
  while (order.size() < 1500) {
    const auto row = static_cast<Eigen::Index>(1 + in.random.index(rows - 1));
    if (std::find_if(order.begin(), order.end(), [row](auto x) { return std::abs(x - row) <= 1; }) ==
        order.end())
      order.push_back(row);
  }
  form.low = 1.0;
  form.high = 1500.0;
  form.at = [order](double count) {
    return acting(Stage::kWritten, [=](State& s) {
      for (std::size_t i = 0; i < std::min(order.size(), static_cast<std::size_t>(std::lround(count))); ++i) {
        for (int output = 0; output < kOutputs; ++output)
          s.output(output)[order[i]] = s.output(output)[order[i] - 1];
        s.amplitude[order[i]] = s.amplitude[order[i] - 1];
      }
    });
  };
  // A repeated value differs from its own by two independent deviates, in each of five channels.
  form.dprime = [](double count) { return std::sqrt(2.0 * 5.0 * std::round(count)); };
  form.parameters = [](double count) { return Values{{"count", std::round(count)}}; };
  return form;
}

Form time_shift(const Setting& in) {
  Form form;
  const bool turning = (in.in.stimuli & kTurn) != 0u;
  const int output = turning ? kRate : in.random.chance(0.6) ? kFrequency : kDrive;
  form.name = output == kRate ? "rate late" : output == kFrequency ? "frequency late" : "drive late";
  form.unmistakable = output != kFrequency;
  form.low = turning ? 1.0 : 0.01;
  form.high = turning ? 12.0 : 120.0;
  form.at = [output](double delay_s) {
    return acting(Stage::kOutput, [=](State& s) { s.output(output) = later(s.output(output), -delay_s); });
  };
  form.parameters = [](double delay_s) { return Values{{"delay", delay_s}}; };
  return form;
}

}  // namespace

std::vector<Kind> signal_kinds() {
  return {{"interference", "", 0, interference, {}},
          {"aliased_carrier", "", 0, aliased_carrier, {}},
          {"rate_flicker", "rate_dph", 0, rate_flicker, {}},
          {"rate_random_walk", "rate_dph", 0, rate_random_walk, {}},
          {"sample_loss", "", 0, sample_loss, {}},
          {"time_shift", "", 0, time_shift, {"pll_lag"}}};
}

}  // namespace hemi::concealed

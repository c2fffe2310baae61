// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/draw.hpp"

#include <algorithm>
#include <cmath>

namespace hemi::concealed {
namespace {

/// Numbers of a model that may be wrong, each with its name; `turning`: the scale factor shows.
struct Number {
  std::string name;
  std::function<double&(Model&)> at;
};

std::vector<Number> numbers(const Model& model, bool turning) {
  std::vector<Number> all;
  for (std::size_t k = 0; k < model.frequency_hz.size(); ++k)
    all.push_back({"frequency.coefficients_hz[" + std::to_string(k) + "]",
                   [k](Model& m) -> double& { return m.frequency_hz[k]; }});
  all.push_back({"thermal.time_constant_s", [](Model& m) -> double& { return m.time_constant_s; }});
  for (const std::size_t k : {0, 1, 2, 4, 7}) {
    static const std::array<const char*, 10> kNames{"1",    "f",    "f^2",  "f^3",    "df",
                                                    "df^2", "df^3", "f*df", "f^2*df", "f*df^2"};
    if (model.bias_dph[k] != 0.0)
      all.push_back({std::string("bias.") + kNames[k], [k](Model& m) -> double& { return m.bias_dph[k]; }});
  }
  if (turning) all.push_back({"scale_factor", [](Model& m) -> double& { return m.scale_factor; }});
  for (std::size_t k = 0; k < 2; ++k) {
    all.push_back({"drive.coefficients_v[" + std::to_string(k) + "]",
                   [k](Model& m) -> double& { return m.drive_v[k]; }});
    all.push_back({"quadrature.coefficients_v[" + std::to_string(k) + "]",
                   [k](Model& m) -> double& { return m.quadrature_v[k]; }});
  }
  return all;
}

Trace raw_difference(const State& a, const State& b) {
  Trace trace;
  for (int output = 0; output < kOutputs; ++output) trace[output] = a.output(output) - b.output(output);
  return trace;
}

}  // namespace

Series rounded(const Series& values, double step) {
  const double per_unit = std::round(1.0 / step);
  return (values * per_unit).round() / per_unit;
}

void read_thermometer(Random& random, Stand& stand) {
  const Nuisance& nuisance = stand.unit.nuisance;
  stand.baseline = simulate(stand.unit.model, stand.in, nuisance.start_offset_degc);
  Series reading = stand.in.case_degc;
  for (double& value : reading) value += nuisance.case_noise_degc * random.normal();
  stand.case_written_degc = rounded(reading, nuisance.case_step_degc);
  stand.thermometer = thermometer_trace(stand.case_written_degc - stand.in.case_degc, stand.baseline,
                                        stand.unit.model, stand.in, nuisance.start_offset_degc);
}

Stand random_stand(Random& random, const std::string& program, unsigned stimuli, bool board_is_resonator,
                   double case_step_degc) {
  Stand stand;
  stand.unit = random_instrument(random);
  if (case_step_degc > 0.0) {
    stand.unit.nuisance.case_step_degc = case_step_degc;
    stand.unit.nuisance.case_noise_degc = random.uniform(0.3, 1.0) * case_step_degc;
  }
  if (board_is_resonator) stand.unit.board_lag_s = stand.unit.model.time_constant_s;
  stand.in = random_excitation(random, stand.unit, program, stimuli);
  read_thermometer(random, stand);
  return stand;
}

Detectability detectability(const Stand& stand) {
  return {stand.unit.model, stand.in, stand.unit.nuisance.start_offset_degc, stand.unit.noise,
          stand.thermometer};
}

Detectability detectability_in(const Stand& stand, const NoiseLevel& more) {
  auto noise = stand.unit.noise;
  NoiseLevel& rate = noise[kRate];
  rate.flicker = std::hypot(rate.flicker, more.flicker);
  rate.random_walk = std::hypot(rate.random_walk, more.random_walk);
  return {stand.unit.model, stand.in, stand.unit.nuisance.start_offset_degc, noise, stand.thermometer};
}

unsigned random_stimuli(Random& random, double rich_share) {
  if (!random.chance(rich_share)) return 0;
  unsigned set = 0;
  for (const unsigned one : {kTurn, kSteps, kTumble, kSupply, kTrim, kBoardLoad})
    if (random.chance(0.7)) set |= one;
  return set;
}

std::optional<Drawn> draw_effect(Random& random, const Stand& stand, const Detectability& limit,
                                 const Kind& kind, Wanted wanted) {
  Drawn drawn{random};
  const Form form = kind.draw({random, stand.in, stand.unit.model, stand.baseline});
  const double offset = stand.unit.nuisance.start_offset_degc;
  const auto measure = [&](double magnitude) {
    drawn.truth.strength = form.sign * magnitude;
    drawn.effect = form.at(drawn.truth.strength);
    if (form.dprime) return form.dprime(magnitude);
    Effects effects = stand.present;
    effects.push_back(drawn.effect);
    drawn.trace = trace_of(simulate(stand.unit.model, stand.in, offset, effects), stand.baseline,
                           stand.unit.model, stand.in, offset);
    return limit.dprime(drawn.trace);
  };
  double dprime = measure(form.high);
  if (!form.scalable) {
    if (dprime < wanted.low || dprime > wanted.high) return std::nullopt;
  } else {
    if (dprime < wanted.low) return std::nullopt;
    const double target = random.log_uniform(wanted.low, std::min(wanted.high, dprime));
    double low = form.low, high = form.high, magnitude = high;
    double power = 1.0;  // of the strength in d', learnt from the last two: 1 where the trace is linear in it
    for (int i = 0; i < 40 && std::abs(dprime / target - 1.0) > 0.01; ++i) {
      (dprime > target ? high : low) = magnitude;
      const double proposal = magnitude * std::pow(target / dprime, 1.0 / power);
      const double before = magnitude, dprime_before = dprime;
      magnitude = proposal > low && proposal < high ? proposal : 0.5 * (low + high);
      if (high - low < 1e-4 * high) break;
      dprime = measure(magnitude);
      power = std::clamp(std::log(dprime / dprime_before) / std::log(magnitude / before), 0.3, 3.0);
    }
    if (dprime < wanted.low || dprime > wanted.high) return std::nullopt;
  }
  drawn.unmistakable = form.unmistakable;
  drawn.noise.flicker = form.noise.flicker * std::abs(drawn.truth.strength);
  drawn.noise.random_walk = form.noise.random_walk * std::abs(drawn.truth.strength);
  drawn.truth.id = kind.id;
  drawn.truth.form = form.name;
  drawn.truth.dprime = drawn.truth.dprime_beside = dprime;
  drawn.truth.parameters = form.parameters(drawn.truth.strength);
  return drawn;
}

std::vector<std::string> change_numbers(Random& random, const Stand& stand, const Detectability& limit,
                                        Model& stated) {
  auto choices = numbers(stand.unit.model, (stand.in.stimuli & kTurn) != 0u);
  std::vector<std::string> changed;
  const std::size_t count = 1 + random.index(3);
  while (changed.size() < count) {
    const std::size_t chosen = random.index(choices.size());
    const Number number = choices[chosen];
    choices.erase(choices.begin() + static_cast<std::ptrdiff_t>(chosen));
    const double offset = stand.unit.nuisance.start_offset_degc;
    Model other = stand.unit.model;
    const double probe = 1e-4 * std::max(std::abs(number.at(other)), 1e-6);
    number.at(other) += probe;
    const double per_probe = limit.raw(raw_difference(simulate(other, stand.in, offset), stand.baseline));
    if (per_probe == 0.0) continue;
    number.at(stated) += random.sign() * probe * random.log_uniform(10.0, 300.0) / per_probe;
    changed.push_back(number.name);
  }
  return changed;
}

void confound_stand(Random& random, Case& result, Stand& stand) {
  const auto name = [&](const std::string& what) { result.confounders.push_back(what); };
  Instrument& unit = stand.unit;
  if (random.chance(0.25)) {
    name("the board's clock is off by a constant");
    const double relative = random.sign() * random.log_uniform(1e-7, 2e-5);
    for (double& value : result.stated.frequency_hz) value *= 1.0 + relative;
  }
  if (random.chance(0.4)) {
    name("flicker in all channels, stated");
    for (int output = 0; output < kOutputs; ++output) {
      unit.noise[output].flicker = unit.noise[output].white * std::sqrt(random.log_uniform(2e-3, 2e-2));
      result.colour_stated[output] = true;
    }
  }
  if (random.chance(0.3)) {
    name("frequency noise rises with frequency, not stated");
    unit.noise[kFrequency].differenced = unit.noise[kFrequency].white * random.uniform(3.0, 10.0);
    result.colour_stated[kFrequency] = false;
  }
  if (random.chance(0.3)) {
    name("heavy-tailed noise");
    for (auto& level : unit.noise) level.shape = NoiseLevel::Shape::kHeavyTailed;
  }
}

void confound_file(Random& random, Case& result) {
  const auto name = [&](const std::string& what) { result.confounders.push_back(what); };
  const auto rows = static_cast<std::size_t>(result.time_s.size());
  const double nothing = std::nan("");
  if (random.chance(0.4)) {
    name("single values missing");
    for (std::size_t i = 0; i < rows / 200; ++i) {
      const auto row = static_cast<Eigen::Index>(random.index(rows));
      result.written.output(static_cast<int>(random.index(kOutputs)))[row] = nothing;
    }
  }
  if (random.chance(0.4)) {
    name("outputs missing for minutes");
    for (std::size_t i = 0; i < 1 + random.index(4); ++i) {
      const auto length = static_cast<Eigen::Index>(60 + random.index(900));
      const auto row = static_cast<Eigen::Index>(random.index(rows - static_cast<std::size_t>(length)));
      for (int output = 0; output < kOutputs; ++output)
        result.written.output(output).segment(row, length).setConstant(nothing);
      result.amplitude.segment(row, length).setConstant(nothing);
    }
  }
  if (random.chance(0.3)) {
    name("rows missing, time stamps right");
    result.tolerated.push_back("sample_loss");
    for (std::size_t i = 0; i < 1 + random.index(5); ++i) {
      const std::size_t length = 1 + random.index(400), from = 1 + random.index(rows - length - 2);
      std::fill_n(result.kept.begin() + static_cast<std::ptrdiff_t>(from), length, false);
    }
  }
  if (random.chance(0.3)) {
    name("time stamps jitter");
    for (double& t : result.time_s) t += 1e-3 * random.normal();
    result.time_s[0] = std::max(result.time_s[0], 0.0);
  }
  if (random.chance(0.2)) {
    name("no board thermometer");
    result.board_recorded = false;
  }
  if ((result.in.stimuli & kSteps) == 0u && random.chance(0.2)) {
    name("amplitude not recorded");
    result.amplitude_recorded = false;
  }
}

}  // namespace hemi::concealed

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/world.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace hemi::physics {

namespace {

/// A seed of its own for each effect, which does not change when others come or go.
std::uint64_t seed_of(const std::string& id, std::uint64_t occurrence, std::uint64_t seed) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // Fowler-Noll-Vo, 1a
  for (const char c : id) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return (hash + occurrence * 0x9e3779b97f4a7c15ULL) ^ (seed * 0xbf58476d1ce4e5b9ULL);
}

/// Value and slope of an ascending polynomial.
std::pair<double, double> polynomial(const std::vector<double>& ascending, double argument) {
  double value = 0.0;
  double slope = 0.0;
  for (auto coefficient = ascending.rbegin(); coefficient != ascending.rend(); ++coefficient) {
    slope = slope * argument + value;
    value = value * argument + *coefficient;
  }
  return {value, slope};
}

/// B(f, df) [deg/h], f from the reference [Hz], df its slope [Hz/s].
double drift_dph(const std::array<double, 10>& k, double f, double df) {
  return k[0] + f * (k[1] + f * (k[2] + f * k[3])) + df * (k[4] + df * (k[5] + df * k[6])) +
         f * df * (k[7] + f * k[8] + df * k[9]);
}

}  // namespace

World::World(const Instrument& instrument, const std::vector<ActiveEffect>& effects, const Environment& start,
             std::uint64_t seed)
    : instrument_(instrument),
      heated_(instrument),
      network_(instrument, start.chamber_degc),
      board_rise_(instrument.board_rise_degc, instrument.board_time_constant_s),
      board_heater_(instrument.board_time_constant_s),
      heater_rise_degc_(start.board_heater_degc) {
  std::map<std::string, std::uint64_t> occurrences;
  for (const ActiveEffect& effect : effects) {
    const auto entry = catalogue().find(effect.id);
    if (entry == catalogue().end()) {
      std::string known;
      for (const auto& [id, unused] : catalogue()) known += (known.empty() ? "" : ", ") + id;
      throw std::invalid_argument(fmt::format("unknown effect '{}'; the catalogue has {}", effect.id, known));
    }
    effects_.push_back(
        entry->second.make(effect.values, instrument_, seed_of(effect.id, occurrences[effect.id]++, seed)));
  }
  conditions_.environment = start;
  conditions_.amplitude = start.amplitude_setpoint;
  board_rise_.start(start.time_s, start.power_on_s);
  update(0.0);
}

void World::advance(const Environment& next, double amplitude) {
  double dt_s = next.time_s - conditions_.environment.time_s;
  if (!(dt_s >= 0.0)) {
    throw std::invalid_argument(
        fmt::format("time runs backwards, from {} s to {} s", conditions_.environment.time_s, next.time_s));
  }
  // Equal steps to the last digit: whatever depends on the step alone is computed once.
  if (step_s_ > 0.0 && same_step(dt_s, step_s_)) {
    dt_s = step_s_;
  } else {
    step_s_ = dt_s;
  }
  conditions_.environment = next;
  conditions_.amplitude = amplitude;
  board_rise_.advance(next.time_s, next.power_on_s);
  heater_rise_degc_ =
      board_heater_.advance(heater_rise_degc_, next.board_heater_degc, next.board_heater_degc, dt_s);
  update(dt_s);
}

void World::update(double dt_s) {
  const Environment& environment = conditions_.environment;
  double heat_degc = 0.0;
  if (!effects_.empty()) {
    heated_ = instrument_;
    for (const auto& effect : effects_) effect->heat(conditions_, dt_s, heated_, heat_degc);
    network_.set_time_constants(heated_);
  }
  network_.advance(environment.chamber_degc, dt_s);

  Temperatures& temperatures = conditions_.temperatures;
  temperatures.case_degc = network_.case_degc();
  temperatures.stem_degc = network_.stem_degc();
  temperatures.shell_degc = network_.shell_degc() + heat_degc;
  temperatures.board_degc = temperatures.case_degc + board_rise_.value_degc() + heater_rise_degc_;
  conditions_.shell_slope_degc_s = network_.shell_slope_degc_s();
  if (dt_s > 0.0) conditions_.shell_slope_degc_s += (heat_degc - heat_degc_) / dt_s;
  heat_degc_ = heat_degc;

  const auto [frequency_hz, sensitivity] =
      polynomial(instrument_.frequency_hz, temperatures.shell_degc - instrument_.frequency_reference_degc);
  conditions_.frequency_hz = frequency_hz;
  conditions_.frequency_slope_hz_s = sensitivity * conditions_.shell_slope_degc_s;

  parameters_ = instrument_.at(temperatures.shell_degc);
  const double scale = parameters_.kappa * instrument_.rebalance_full_scale_dps * 3600.0 *
                       kRadPerSecondPerDph / parameters_.rebalance_per_s;
  const double drift = drift_dph(instrument_.bias_terms_dph, frequency_hz - instrument_.bias_reference_hz,
                                 conditions_.frequency_slope_hz_s);
  parameters_.rate_rad_s = (environment.rate_dph + drift / scale) * kRadPerSecondPerDph;
  parameters_.rate_slope_rad_s2 = environment.rate_slope_dph_s * kRadPerSecondPerDph;
  for (const auto& effect : effects_) effect->act(conditions_, dt_s, parameters_);
}

void World::distort(std::vector<TelemetrySample>& telemetry) {
  for (const auto& effect : effects_) effect->distort(telemetry);
}

}  // namespace hemi::physics

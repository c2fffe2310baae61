// SPDX-License-Identifier: Apache-2.0
// Everything slow around the resonator: thermal network, nominal parameters over temperature, drift, effects.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "golden/physics/effect.hpp"
#include "golden/physics/thermal_network.hpp"

namespace hemi::physics {

/// Which effects act, with which parameters.
struct ActiveEffect {
  std::string id;
  EffectValues values;
};

/// Advances temperatures and parameters; shared by the full-rate plant (steps of a millisecond) and the slow
/// twin (steps of one telemetry sample), so that both see the same world.
class World {
 public:
  /// Starts in equilibrium with `start`. Throws std::invalid_argument for unknown effects or impossible
  /// values.
  World(const Instrument& instrument, const std::vector<ActiveEffect>& effects, const Environment& start,
        std::uint64_t seed);

  /// Moves to `next.time_s`; the chamber between is taken as linear, all else as `next` says. amplitude: of
  /// the primary, nominal amplitudes. Throws std::invalid_argument where time runs backwards.
  void advance(const Environment& next, double amplitude);

  const Parameters& parameters() const { return parameters_; }
  const Conditions& conditions() const { return conditions_; }
  const Instrument& instrument() const { return instrument_; }
  void distort(std::vector<TelemetrySample>& telemetry);

 private:
  void update(double dt_s);

  Instrument instrument_;
  Instrument heated_;  ///< the instrument with the time constants that the effects want at this update
  std::vector<std::unique_ptr<Effect>> effects_;
  Conditions conditions_;
  Parameters parameters_;
  ThermalNetwork network_;
  PowerOnRise board_rise_;
  Pole board_heater_;
  double heater_rise_degc_ = 0.0;
  double heat_degc_ = 0.0;
  double step_s_ = 0.0;
};

}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
// An effect of the catalogue: physics that a nominal instrument leaves out. One file an effect in effects/,
// found by registration.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "golden/physics/instrument.hpp"
#include "golden/physics/parameters.hpp"

namespace hemi::physics {

/// State of the instrument as an effect sees it.
struct Conditions {
  Environment environment;
  Temperatures temperatures;
  double shell_slope_degc_s = 0.0;
  double frequency_hz = 0.0;  ///< true natural frequency before effects
  double frequency_slope_hz_s = 0.0;
  double amplitude = 1.0;  ///< of the primary, in nominal amplitudes
};

/// One telemetry sample, as the channels of a recording.
struct TelemetrySample {
  double time_s = 0.0;
  double case_temp_degc = 0.0;
  double board_temp_degc = 0.0;
  double rate_in_dph = 0.0;
  double accel_g = 0.0;
  double supply_v = 0.0;
  double quadrature_trim_v = 0.0;
  double frequency_hz = 0.0;
  double amplitude = 0.0;
  double drive_v = 0.0;
  double quadrature_v = 0.0;
  double rate_dph = 0.0;
};

/// Values of an effect's parameters by name, in the units that its description states.
using EffectValues = std::map<std::string, double, std::less<>>;

/// One parameter: name and unit are fixed (they are scored).
struct EffectParameter {
  std::string name;
  std::string unit;
  double typical;
  double lowest;  ///< physically possible range
  double highest;
  std::string meaning;
};

/// What `hemi effects ID` prints.
struct EffectDescription {
  std::string id;
  std::string equation;
  std::string explanation;
  std::vector<std::string> channels;       ///< of a recording, where it shows
  std::vector<std::string> confused_with;  ///< ids
  std::string separated_by;                ///< experiment
  std::vector<EffectParameter> parameters;
};

/// One effect at work. Full-rate plant and slow twin call the same two functions.
class Effect {
 public:
  virtual ~Effect() = default;
  /// Before anything else of an update: heat sources and time constants. `instrument` is a fresh copy of the
  /// nominal one in which time constants of the thermal network may be changed; `heat_degc` is the rise of
  /// the shell over what the network alone gives, the lag of that rise included. The conditions are still
  /// those of the update before.
  virtual void heat(const Conditions&, double /*dt_s*/, Instrument& /*instrument*/, double& /*heat_degc*/) {}
  /// Every update, dt_s after the one before (0: the first): adds its part to parameters that are fresh from
  /// the nominal instrument. The conditions are those at the end of the step.
  virtual void act(const Conditions&, double /*dt_s*/, Parameters&) {}
  /// On the finished telemetry, in order of time: faults of the electronics behind the core (lag, slips,
  /// losses, lines).
  virtual void distort(std::vector<TelemetrySample>&) {}
};

/// The catalogue; its order is that of the ids.
struct CatalogueEntry {
  EffectDescription description;
  /// values: complete or not, the typical ones fill in. Throws std::invalid_argument naming effect, parameter
  /// and range for unknown names and for values out of the physical range.
  std::function<std::unique_ptr<Effect>(const EffectValues&, const Instrument&, std::uint64_t seed)> make;
};
const std::map<std::string, CatalogueEntry, std::less<>>& catalogue();

/// Builds an effect from complete, checked values.
using EffectMaker =
    std::function<std::unique_ptr<Effect>(const EffectValues&, const Instrument&, std::uint64_t seed)>;

/// Registers an effect at program start: `const Registration entry{{...}, construct<T>};` at namespace scope
/// of its file.
struct Registration {
  Registration(EffectDescription description, EffectMaker make);
};

/// The maker of an effect whose constructor takes the same three arguments.
template <typename T>
std::unique_ptr<Effect> construct(const EffectValues& values, const Instrument& instrument,
                                  std::uint64_t seed) {
  return std::make_unique<T>(values, instrument, seed);
}

}  // namespace hemi::physics

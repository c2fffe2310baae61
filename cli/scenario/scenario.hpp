// SPDX-License-Identifier: Apache-2.0
// A scenario: what `hemi simulate` is to do. Reference of all keys: docs/scenarios.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/recording/model.hpp"
#include "cli/scenario/inputs.hpp"
#include "cli/scenario/model_instrument.hpp"
#include "golden/physics/instrument.hpp"
#include "golden/physics/world.hpp"

namespace hemi::scenario {

enum class Mode {
  slow,  ///< averaged equations, one step a telemetry sample
  full   ///< plant at the ADC's rate, closed around an engine
};

/// Stretch of pickoff samples to keep.
struct RawStretch {
  double from_s;
  double to_s;
  std::string format;  ///< csv, wav or h5
};

/// Closed-loop -3 dB bandwidths.
struct LoopBandwidths {
  double reference_phase_hz = 10.0;
  double rebalance_hz = 40.0;
  double quadrature_hz = 1.0;
  double amplitude_hz = 0.5;
};

/// Vibration that the resonator has when the run begins.
struct StartVibration {
  double amplitude = 0.1;  ///< nominal amplitudes
  double phase_deg = 0.0;
};

struct Scenario {
  std::string path;
  std::string name;
  std::string device;
  std::string started;  ///< ISO 8601, or empty
  Mode mode = Mode::slow;
  std::string engine = "hls";  ///< full mode
  bool wide = false;           ///< full mode: config::Wide
  double duration_s = 0.0;
  double telemetry_rate_hz = 1.0;
  std::uint64_t seed = 1;
  bool noise = true;
  std::optional<RawStretch> raw{};
  LoopBandwidths loops{};
  StartVibration vibration{};
  physics::Instrument instrument{};
  std::string model_path;  ///< of [instrument] model, or empty
  Inputs inputs{};
  std::vector<physics::ActiveEffect> effects{};  ///< every parameter filled in

  std::size_t rows() const;
  /// Of the chamber, five degrees more on either side.
  TemperatureRange temperatures() const;
  recording::InstrumentModel nominal_model() const;
};

/// Reads and checks. InputError (file, line, key, problem, remedy) for everything that docs/scenarios.md does
/// not allow and for physics that cannot be.
Scenario read_scenario(const std::string& path);

}  // namespace hemi::scenario

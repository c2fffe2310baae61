// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/recording/raw_capture.hpp"
#include "cli/scenario/scenario.hpp"
#include "golden/physics/effect.hpp"

namespace hemi::scenario {

/// What a run leaves. Words of the core are there in mode full alone, one a telemetry sample.
struct Simulated {
  std::vector<physics::TelemetrySample> telemetry{};
  std::vector<double> compensated_rate_dph{};
  std::vector<double> temperature_degc{};
  std::vector<double> status{};
  std::optional<recording::RawCapture> raw{};
  std::vector<std::string> notes{};
};

/// The slow twin along the inputs. Deterministic by seed. InputError where inputs and effects do not go
/// together; Interrupted.
Simulated simulate_slow(const Scenario& scenario);

/// The plant at the ADC's rate, closed around the scenario's engine. Deterministic by seed. InputError for
/// bandwidths that the delay does not allow; Interrupted.
Simulated simulate_full(const Scenario& scenario);

/// Telemetry as the format's channels.
recording::Recording to_recording(const Simulated& simulated, const Scenario& scenario);

}  // namespace hemi::scenario

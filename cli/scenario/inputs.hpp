// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "cli/scenario/section.hpp"
#include "cli/scenario/signal.hpp"
#include "golden/physics/parameters.hpp"

namespace hemi::scenario {

/// What chamber, turntable and user do, over time.
struct Inputs {
  Signal chamber_degc{20.0};
  Signal rate_dph{0.0};  ///< as the table turns
  Signal accel_g{0.0};
  Signal supply_v{5.0};
  Signal setpoint{1.0};
  Signal trim_v{0.0};
  Signal heater_degc{0.0};
  double power_on_s = 0.0;
  double scale_factor = 1.0;  ///< rate that the instrument feels over rate_dph

  physics::Environment at(double time_s) const;
  /// When the last of the profiles ends; 0 where there is none.
  double end_s() const;
};

/// Sections of a scenario that hold inputs.
inline constexpr std::array<std::string_view, 7> kInputSections = {
    "chamber", "table", "supply", "attitude", "amplitude", "quadrature", "board"};

/// InputError for whatever docs/scenarios.md does not allow.
Inputs read_inputs(const Section& scenario);

}  // namespace hemi::scenario

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/diagnosis/telemetry_diagnosis.hpp"

namespace hemi::diagnosis {

/// What the named effects leave: free functions of inputs that are worth their price, colour of the rate
/// beyond what the model states, and outputs that move along no input. Fills `remainders` and `colours` from
/// `hypotheses`, `members` and `final`.
void look_at_remainder(TelemetryDiagnosis& result);

}  // namespace hemi::diagnosis

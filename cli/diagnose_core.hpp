// SPDX-License-Identifier: Apache-2.0
// Files with which the core compensates what a diagnosis of telemetry has found.
#ifndef HEMI_CLI_DIAGNOSE_CORE_HPP
#define HEMI_CLI_DIAGNOSE_CORE_HPP

#include <string>

#include "cli/recording/json.hpp"
#include "cli/recording/model.hpp"
#include "golden/diagnosis/telemetry_diagnosis.hpp"

namespace hemi::cli {

/// Where the diagnosis named physics or moved the model's parameters: writes core.model.json and
/// core.registers.json into the directory and returns the section `core` of diagnosis.json; `not_written`
/// with the reason where the core cannot hold the correction. Null where there is nothing to correct or the
/// model has no f(T) or no bias. `nominal`: `given` as the diagnosis took it.
recording::Json write_core(const diagnosis::TelemetryDiagnosis& result,
                           const diagnosis::NominalModel& nominal, const recording::InstrumentModel& given,
                           const recording::InstrumentModel& corrected, const std::string& directory);

/// The section in words; empty for null.
std::string core_text(const recording::Json& core);

}  // namespace hemi::cli

#endif  // HEMI_CLI_DIAGNOSE_CORE_HPP

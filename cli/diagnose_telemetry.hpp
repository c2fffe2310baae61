// SPDX-License-Identifier: Apache-2.0
// Diagnosis of a gyro's telemetry: what the instrument model leaves out of a recording.
#ifndef HEMI_CLI_DIAGNOSE_TELEMETRY_HPP
#define HEMI_CLI_DIAGNOSE_TELEMETRY_HPP

#include <string>

#include "cli/diagnosis_input.hpp"
#include "cli/recording/json.hpp"
#include "cli/recording/model.hpp"
#include "cli/recording/recording.hpp"
#include "golden/diagnosis/located.hpp"

namespace hemi::cli {

struct DiagnoseTelemetryOptions {
  std::string model;            ///< hemi-model/1
  std::string directory = ".";  ///< is made where it is absent
  bool json = false;            ///< diagnosis.json on standard output too, in place of the text
};

/// At least one of frequency_hz, drive_v, quadrature_v, and no force_v.
bool holds_telemetry(const recording::Recording& recording);

/// Format hemi-diagnosis/1.
recording::Json to_json(const diagnosis::TelemetryDiagnosis& result, const DiagnosisInput& input,
                        const recording::Recording& recording, const std::string& model);
std::string to_text(const recording::Json& json);
/// The model with its parameters refitted and what was named as `effects`.
recording::InstrumentModel corrected_model(const diagnosis::TelemetryDiagnosis& result,
                                           const recording::InstrumentModel& given);

/// Runs the diagnosis, writes diagnosis.json, corrected.model.json and report.html, prints; 0 consistent, 1
/// otherwise. InputError where recording and model do not go together.
int diagnose_telemetry(const recording::Recording& recording, const DiagnoseTelemetryOptions& options);

}  // namespace hemi::cli

#endif  // HEMI_CLI_DIAGNOSE_TELEMETRY_HPP

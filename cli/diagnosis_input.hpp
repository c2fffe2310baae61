// SPDX-License-Identifier: Apache-2.0
// A recording and a model as the diagnosis takes them.
#ifndef HEMI_CLI_DIAGNOSIS_INPUT_HPP
#define HEMI_CLI_DIAGNOSIS_INPUT_HPP

#include <string>
#include <vector>

#include "cli/recording/model.hpp"
#include "cli/recording/recording.hpp"
#include "golden/diagnosis/telemetry.hpp"

namespace hemi::cli {

struct DiagnosisInput {
  diagnosis::Telemetry telemetry;
  std::vector<std::string> notes;   ///< what was made of the recording, a sentence each
  std::vector<std::string> absent;  ///< channels that it does not have
  std::size_t averaged_rows = 1;    ///< rows of the recording in one of the telemetry
};

/// Rows on an even grid of time, `decimation` of them averaged into one so that no more than `most_rows`
/// remain; rows that are missing hold NaN in the outputs, inputs are carried over them (thermometers by a
/// cubic). Without case_temp_degc the frequency is the thermometer, and no output any more.
/// InputError where there is nothing to diagnose.
DiagnosisInput telemetry_of(const recording::Recording& recording, const recording::InstrumentModel& model,
                            std::size_t most_rows);

/// Without case_temp_degc no time constant, since the thermometer is the resonator itself.
/// InputError naming the part of the model that a channel of the recording needs and that is missing.
diagnosis::NominalModel nominal_of(const recording::InstrumentModel& model,
                                   const recording::Recording& recording);

}  // namespace hemi::cli

#endif  // HEMI_CLI_DIAGNOSIS_INPUT_HPP

// SPDX-License-Identifier: Apache-2.0
// Diagnosis of recordings that hold only the case's temperature and the rate.
#ifndef HEMI_CLI_DIAGNOSE_CASE_HPP
#define HEMI_CLI_DIAGNOSE_CASE_HPP

#include <string>

#include "cli/recording/json.hpp"
#include "cli/recording/recording.hpp"
#include "golden/diagnosis/case_memory.hpp"

namespace hemi::cli {

struct DiagnoseCaseOptions {
  std::string directory = ".";  ///< is made where it is absent; diagnosis.json goes there
  bool json = false;            ///< diagnosis.json on standard output too, in place of the text
};

/// rate_dph and case_temp_degc, no frequency_hz and no force_v.
bool holds_case_and_rate(const recording::Recording& recording);

/// The rows that hold both, the applied rate taken off, averaged where there are more than 20 000. InputError
/// for fewer than 256 or a temperature that does not move.
diagnosis::CaseRows case_rows(const recording::Recording& recording);

/// Format hemi-diagnosis/1. `samples`: times are row numbers.
recording::Json to_json(const diagnosis::CaseMemory& result, const recording::Recording& recording);
std::string to_text(const diagnosis::CaseMemory& result, const recording::Recording& recording);

/// Runs the diagnosis, writes diagnosis.json, prints; 0 consistent, 1 otherwise.
int diagnose_case(const recording::Recording& recording, const DiagnoseCaseOptions& options);

}  // namespace hemi::cli

#endif  // HEMI_CLI_DIAGNOSE_CASE_HPP

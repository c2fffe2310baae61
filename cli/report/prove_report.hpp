// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_CLI_REPORT_PROVE_REPORT_HPP
#define HEMI_CLI_REPORT_PROVE_REPORT_HPP

#include <string>

#include "cli/recording/json.hpp"

namespace hemi::report {

/// Renders a hemi-proof/1 object (prove.json): every figure with interval and target, rival methods beside
/// it, right answers by class, stated probabilities against the share that was right, the confusion matrix,
/// the failures one by one. Absent keys leave their part out. OutputError where the file cannot be written.
void write_prove_report(const std::string& path, const recording::Json& proof);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_PROVE_REPORT_HPP

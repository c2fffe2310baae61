// SPDX-License-Identifier: Apache-2.0
// Effects of the catalogue that a recording cannot show, and why.
#ifndef HEMI_CLI_UNTESTABLE_HPP
#define HEMI_CLI_UNTESTABLE_HPP

#include <string>
#include <vector>

#include "cli/diagnosis_input.hpp"
#include "cli/recording/json.hpp"

namespace hemi::cli {

struct Untestable {
  std::string id;
  std::string why;
};

/// In the order of the catalogue: channels that were not recorded, inputs that stand still, rows that were
/// averaged, and what telemetry never shows. `tested`: effects of which the diagnosis tried a form.
std::vector<Untestable> untestable(const DiagnosisInput& input, const std::vector<std::string>& tested);

/// Section `not_testable` of diagnosis.json in words, one line a reason; empty for an empty list.
std::string untestable_text(const recording::Json& list);

}  // namespace hemi::cli

#endif  // HEMI_CLI_UNTESTABLE_HPP

// SPDX-License-Identifier: Apache-2.0
// Words and tables out of hemi-diagnosis/1.
#ifndef HEMI_CLI_REPORT_DIAGNOSIS_TEXT_HPP
#define HEMI_CLI_REPORT_DIAGNOSIS_TEXT_HPP

#include <optional>
#include <string>
#include <vector>

#include "cli/recording/json.hpp"
#include "cli/report/report.hpp"

namespace hemi::report {

/// object[key], or null where it is absent or `object` is no object.
const recording::Json& member(const recording::Json& object, const char* key);
/// As text: strings as they are, nothing for null, others as JSON.
std::string text_of(const recording::Json& value);
std::optional<double> number_of(const recording::Json& value);
/// "a to b" of a two-element array; empty for anything else.
std::string range_of(const recording::Json& value, const std::string& unit = {});
/// Four digits; "–" where there is no number.
std::string cell(const recording::Json& value);

/// Names of the catalogue as words: thermal_hysteresis -> thermal hysteresis.
std::string in_words(std::string id);
/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& names);

/// The verdict as one sentence, and how it looks.
struct Verdict {
  std::string sentence;
  Tone tone;
};
/// `unit_of_channel`: unit of a channel's residual.
Verdict verdict_of(const recording::Json& diagnosis,
                   const std::vector<std::pair<std::string, std::string>>& units);

/// One row an entry of `improvement`: channel and rows, before, after, floor, gain.
Table proof_table(const recording::Json& diagnosis,
                  const std::vector<std::pair<std::string, std::string>>& units);
Table located_table(const recording::Json& diagnosis, const std::string& time_unit);
Table parameter_table(const recording::Json& effect);
Table limits_table(const recording::Json& diagnosis);
Table alternatives_table(const recording::Json& diagnosis);
/// Effects that the recording cannot show, and why.
Table not_testable_table(const recording::Json& diagnosis);

/// The lists of a diagnosis that hold what was compared (`tests`, `orders`, `families`), a table each: one
/// column a key of the first entry, its name in words. Empty lists give none.
std::vector<Table> evidence_tables(const recording::Json& diagnosis);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_DIAGNOSIS_TEXT_HPP

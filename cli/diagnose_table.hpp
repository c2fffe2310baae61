// SPDX-License-Identifier: Apache-2.0
// Diagnosis of a table of settled points: is the order of f(T) enough?
#ifndef HEMI_CLI_DIAGNOSE_TABLE_HPP
#define HEMI_CLI_DIAGNOSE_TABLE_HPP

#include <string>

#include "cli/recording/json.hpp"
#include "golden/diagnosis/settled_table.hpp"

namespace hemi::cli {

struct DiagnoseTableOptions {
  std::string points;           ///< CSV file with settled_degc and frequency_hz
  int order = 3;                ///< of the model that is judged; 3 is the paper's
  std::string directory = ".";  ///< is made where it is absent; diagnosis.json goes there
  bool json = false;            ///< diagnosis.json on standard output too, in place of the text
};

/// Format hemi-diagnosis/1.
recording::Json to_json(const diagnosis::TableDiagnosis& result, const std::string& path);
std::string to_text(const diagnosis::TableDiagnosis& result);

/// Runs the diagnosis, writes diagnosis.json, prints; 0 consistent, 1 otherwise. InputError for a file that
/// cannot be used or that has too few points to test one order more. Files it is for: holds_settled_points.
int diagnose_table(const DiagnoseTableOptions& options);

}  // namespace hemi::cli

#endif  // HEMI_CLI_DIAGNOSE_TABLE_HPP

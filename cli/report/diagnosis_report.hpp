// SPDX-License-Identifier: Apache-2.0
// The page that goes beside diagnosis.json. Call it after the JSON is complete:
//
//   std::vector<report::ReportSeries> series;
//   series.push_back({.channel = "rate_dph", .unit = "deg/h", .time_s = t, .before = before, .after =
//   after}); report::write_diagnosis_report((directory / "report.html").string(), json, series, {.command =
//   "hemi diagnose ..."});
//
// Link hemi_report. All that the JSON holds comes from the JSON; only the curves come from `series`.
#ifndef HEMI_CLI_REPORT_DIAGNOSIS_REPORT_HPP
#define HEMI_CLI_REPORT_DIAGNOSIS_REPORT_HPP

#include <string>
#include <vector>

#include "cli/recording/json.hpp"
#include "cli/report/report.hpp"

namespace hemi::report {

/// Residual (recorded minus simulated) of one channel. All vectors have one length; NaN: missing or not
/// predicted. `after` may be empty where nothing was named. Rows in the order of time; `time_s` in seconds,
/// or in samples where DiagnosisPage::time_unit says so.
struct ReportSeries {
  std::string channel{};         ///< as in the JSON's `located` and `improvement`
  std::string unit{};            ///< of both residuals
  std::vector<double> time_s{};  ///< ascending
  std::vector<double> before{};  ///< with the model as given
  std::vector<double> after{};   ///< with what was named (or recalibrated)
  /// What the misfit goes with, for a second plot of the residual against it (case_temp_degc, say); empty:
  /// none.
  std::string over_name{};
  std::string over_unit{};
  std::vector<double> over{};  ///< one value a row
  /// Rows from here on were not fitted (held out), as times; empty: none. Drawn with their own shade.
  std::vector<std::pair<double, double>> held_out_s{};
};

struct DiagnosisPage {
  std::string command{};        ///< that makes this page, printed at its foot
  std::string time_unit = "s";  ///< or "samples"
  std::vector<Plot> plots{};    ///< behind the residuals, for what no series over time shows
};

/// Renders a hemi-diagnosis/1 object: the verdict in one sentence; where (located stretches shaded in the
/// residuals, the stage marked in the chain); what (effects with equation, parameters, intervals); the proof
/// (before, after, floor, on rows fitted and held out; Allan deviation and spectrum of the residuals); what
/// is not excluded (detection limits); the tests, orders and families that were compared; which experiment
/// separates what is left; what remains. Keys that are absent leave their part out; unknown keys are ignored.
/// The file appears whole or not at all; OutputError where it cannot be written, std::invalid_argument for
/// vectors of unequal length.
void write_diagnosis_report(const std::string& path, const recording::Json& diagnosis,
                            const std::vector<ReportSeries>& series, const DiagnosisPage& page = {});

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_DIAGNOSIS_REPORT_HPP

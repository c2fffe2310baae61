// SPDX-License-Identifier: Apache-2.0
// Pages with everything in them, for the tests in a browser.
#ifndef HEMI_TESTS_CLI_REPORT_PAGES_HPP
#define HEMI_TESTS_CLI_REPORT_PAGES_HPP

#include <string>
#include <vector>

#include "cli/recording/json.hpp"
#include "cli/report/diagnosis_report.hpp"
#include "cli/report/report.hpp"

namespace hemi::report_test {

/// Where a value was put that stands out of its surroundings by one sample.
struct Spike {
  std::size_t channel;
  double time_s, value;
};

/// Telemetry of six channels: slow course, noise, and one single sample in each that no other reaches.
struct Telemetry {
  std::vector<double> time_s;
  std::vector<std::vector<double>> channels;
  std::vector<Spike> spikes;
};
Telemetry telemetry(std::size_t rows, double rate_hz);
report::Report telemetry_report(const Telemetry& telemetry);

/// A hemi-diagnosis/1 object with every key of the format, verdict `named`, and its residuals.
recording::Json diagnosis_json();
std::vector<report::ReportSeries> diagnosis_series();

/// A hemi-proof/1 object in which one figure misses its target.
recording::Json proof_json();

/// All kinds of parts on one page, text that would be markup among them.
report::Report mixed_report();

}  // namespace hemi::report_test

#endif  // HEMI_TESTS_CLI_REPORT_PAGES_HPP

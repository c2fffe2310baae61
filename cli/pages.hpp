// SPDX-License-Identifier: Apache-2.0
// The HTML reports of the subcommands (option --report).
#ifndef HEMI_CLI_PAGES_HPP
#define HEMI_CLI_PAGES_HPP

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/calibrate.hpp"
#include "cli/recording/json.hpp"
#include "cli/recording/recording.hpp"
#include "cli/report/report.hpp"
#include "golden/calibration/allan.hpp"

namespace hemi::cli {

inline constexpr const char* report_option_help = "HTML report: a directory, or a file that ends in .html";

/// Channels over time on one axis, in the recording's order; channels without a value are left out. The last
/// plot carries `stretch_command`.
std::vector<report::Plot> channel_plots(const recording::Recording& recording,
                                        const std::string& stretch_command,
                                        std::size_t buckets = report::kBuckets);

/// A command that shows a stretch of a file at full resolution, for Plot::stretch_command.
std::string stretch_command(const std::string& recording);

struct AllanPage {
  std::string recording, channel, unit;
  const recording::Recording& source;
  double interval_s;
  const calibration::AllanResult& result;
  double average_s;
  std::optional<double> bias_stability;
  Eigen::Index samples = 0;  ///< that entered
  bool separate = false;     ///< averages that do not overlap
};
/// All write their page to report::report_path(target, NAME), and return where.
std::string write_allan_page(const std::string& target, const AllanPage& page);

/// `summary`: what the command prints with --json.
std::string write_run_page(const std::string& target, const recording::Recording& output,
                           const recording::Json& summary, const std::string& source,
                           const std::string& engine, const std::string& text);

struct ComparedPair {
  std::string first{}, second{};
  bool equal = true;
  std::uint64_t records = 0, differing_records = 0, words = 0;
  std::string block{}, word{};  ///< of the first difference; empty where all blocks agree
  std::uint64_t sample = 0;
  std::string report{};  ///< the first difference in words
};
struct ComparePage {
  std::string recording{};
  std::vector<ComparedPair> pairs{};
  /// Outputs of the first engine, and of the one that differs from it first.
  recording::Recording outputs{}, other_outputs{};
  std::string differing{};  ///< name of that engine; empty: none
  std::string ideal{};      ///< differences to the ideal chain in words
};
std::string write_compare_page(const std::string& target, const ComparePage& page);

/// Plots of a calibration, made while its data are at hand.
std::vector<report::Plot> calibration_plots(const std::optional<ThermalStudy>& thermal,
                                            const std::optional<DriftData>& drift,
                                            const Calibration& calibration);
/// f(T) and what the settled points of a file leave.
std::vector<report::Plot> settled_plots(const std::string& path, const Calibration& calibration);
std::string write_calibration_page(const Calibration& calibration);

}  // namespace hemi::cli

#endif  // HEMI_CLI_PAGES_HPP

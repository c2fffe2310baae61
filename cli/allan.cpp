// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/pages.hpp"
#include "cli/recording/channels.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/recording.hpp"
#include "golden/calibration/allan.hpp"

namespace hemi::cli {
namespace {

struct AllanOptions {
  std::string recording;
  std::string channel = "rate_dph";
  double average_s = 100.0;
  std::string report;
  bool decades = false;
  bool json = false;
};

/// The longest stretch without a missing value or a gap.
Eigen::VectorXd longest_stretch(const recording::Recording& recording, const std::vector<double>& values) {
  std::vector<bool> starts(values.size() + 1, false);
  for (const auto& gap : recording.gaps) starts[gap.after_row + 1] = true;
  std::size_t best = 0, best_at = 0, at = 0;
  for (std::size_t i = 0; i <= values.size(); ++i) {
    if (i < values.size() && !std::isnan(values[i]) && !starts[i]) continue;
    if (i - at > best) {
      best = i - at;
      best_at = at;
    }
    at = i < values.size() && std::isnan(values[i]) ? i + 1 : i;
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data() + best_at, static_cast<Eigen::Index>(best));
}

int allan(const AllanOptions& options) {
  refuse_settled_points(options.recording);
  refuse_overwriting({options.report}, {options.recording});
  const auto recording = recording::read_recording(options.recording);
  const auto& values = recording.require(options.channel, "the Allan deviation");
  const Eigen::VectorXd stretch = longest_stretch(recording, values);
  const double interval_s = 1.0 / recording.sample_rate_hz;
  if (stretch.size() < 3) {
    throw recording::InputError({options.recording, 0, 0, options.channel},
                                "has no three samples without a gap between them", "record longer");
  }
  if (options.average_s < interval_s) {
    throw recording::InputError(
        {options.recording},
        fmt::format("samples every {:.6g} s have no averages over {:.6g} s", interval_s, options.average_s),
        "ask for a longer --average");
  }
  print_notes(recording.notes);
  const std::string unit(recording::find_channel(options.channel)->unit);
  const auto result = calibration::allan_deviation(
      stretch, interval_s,
      options.decades ? calibration::TauSpacing::kDecade : calibration::TauSpacing::kOctave);
  const bool stability =
      static_cast<double>(stretch.size()) >= 2.0 * std::round(options.average_s / interval_s);
  const auto stable = stability
                          ? std::optional(calibration::bias_stability(stretch, interval_s, options.average_s))
                          : std::nullopt;
  std::string page;
  if (!options.report.empty())
    page = write_allan_page(options.report, {options.recording, options.channel, unit, stretch, interval_s,
                                             result, options.average_s, stable});
  if (options.json) {
    recording::Json json{{"channel", options.channel},
                         {"unit", unit},
                         {"samples", stretch.size()},
                         {"interval_s", interval_s}};
    for (const auto& p : result.points) {
      json["points"].push_back({{"tau_s", p.tau_s},
                                {"deviation", p.deviation},
                                {"lower", p.lower},
                                {"upper", p.upper},
                                {"pairs", p.pairs}});
    }
    json["bias_instability"] = {{"value", result.bias_instability},
                                {"tau_s", result.bias_instability_tau_s},
                                {"upper_bound", result.bias_instability_is_bound}};
    if (result.angle_random_walk)
      json["angle_random_walk_per_root_s"] = result.angle_random_walk->coefficient;
    if (stable) json["bias_stability"] = {{"average_s", options.average_s}, {"value", *stable}};
    if (!page.empty()) json["report"] = page;
    fmt::print("{}\n", recording::json_text(json, 2));
    return exit_good;
  }
  fmt::print("overlapping Allan deviation of {} [{}], {} of {} samples every {:.6g} s\n", options.channel,
             unit, stretch.size(), values.size(), interval_s);
  fmt::print("       tau s      deviation    68 % interval             pairs\n");
  for (const auto& p : result.points)
    fmt::print("{:>12.6g} {:>14.6g}    {:<11.6g} {:<11.6g} {:>8}\n", p.tau_s, p.deviation, p.lower, p.upper,
               p.pairs);
  fmt::print("bias instability {:.6g} {} at {:.6g} s{}\n", result.bias_instability, unit,
             result.bias_instability_tau_s,
             result.bias_instability_is_bound ? " (still falling at the longest tau: an upper bound)" : "");
  if (result.angle_random_walk) {
    const auto& walk = *result.angle_random_walk;
    fmt::print("angle random walk {:.6g} {} root s, read from {:.6g} to {:.6g} s\n", walk.coefficient, unit,
               walk.from_s, walk.to_s);
  } else {
    fmt::print("angle random walk: no stretch of slope -1/2 over a decade, so none is given\n");
  }
  if (stable) {
    fmt::print("bias stability (standard deviation of {:.6g} s averages) {:.6g} {}\n", options.average_s,
               *stable, unit);
  }
  if (!page.empty()) fmt::print("wrote {}\n", page);
  return exit_good;
}

}  // namespace

void add_allan(CLI::App& app, Job& job) {
  auto options = std::make_shared<AllanOptions>();
  auto* command = app.add_subcommand("allan", "Overlapping Allan deviation and bias stability of a channel");
  command->add_option("recording", options->recording, "telemetry, or an output of hemi run")->required();
  command->add_option("-c,--channel", options->channel, "which channel")->capture_default_str();
  command->add_option("--average", options->average_s, "averaging time of the bias stability [s]")
      ->check(positive_number())
      ->capture_default_str();
  command->add_flag("--decades", options->decades, "tau in decades instead of octaves");
  command->add_option("--report", options->report, report_option_help);
  command->add_flag("--json", options->json, "result as JSON");
  command->footer("Example: hemi allan out.csv --channel compensated_rate_dph");
  command->callback([options, &job] { job = [options] { return allan(*options); }; });
}

}  // namespace hemi::cli

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
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
  bool separate = false;
  bool json = false;
};

/// Stretches without a missing value or a gap.
std::vector<calibration::RowRange> stretches_of(const recording::Recording& recording,
                                                const std::vector<double>& values) {
  std::vector<bool> starts(values.size() + 1, false);
  for (const auto& gap : recording.gaps) starts[gap.after_row + 1] = true;
  std::vector<calibration::RowRange> stretches;
  Eigen::Index begin = 0;
  for (std::size_t i = 0; i <= values.size(); ++i) {
    const bool missing = i < values.size() && std::isnan(values[i]);
    if (i < values.size() && !missing && !starts[i]) continue;
    const auto end = static_cast<Eigen::Index>(i);
    if (end > begin) stretches.push_back({begin, end - begin});
    begin = missing ? end + 1 : end;
  }
  return stretches;
}

recording::Json reading_as_json(const std::optional<calibration::NoiseReading>& reading) {
  if (!reading) return nullptr;
  return {{"value", reading->coefficient}, {"from_s", reading->from_s}, {"to_s", reading->to_s}};
}

recording::Json as_json(const calibration::AllanResult& result) {
  recording::Json json;
  for (const auto& p : result.points) {
    json["points"].push_back({{"tau_s", p.tau_s},
                              {"deviation", p.deviation},
                              {"lower", p.lower},
                              {"upper", p.upper},
                              {"pairs", p.pairs}});
  }
  json["bias_instability"] = {{"value", result.bias_instability},
                              {"tau_s", result.bias_instability_tau_s},
                              {"upper_bound", !result.flicker.has_value()}};
  json["flicker"] = reading_as_json(result.flicker);
  json["rate_random_walk"] = reading_as_json(result.rate_random_walk);
  if (result.angle_random_walk) json["angle_random_walk_per_root_s"] = result.angle_random_walk->coefficient;
  return json;
}

/// The three terms of the rate's noise, each with the stretch that it was read from, or why there is none.
void print_terms(const calibration::AllanResult& result, const std::string& unit) {
  if (const auto& walk = result.angle_random_walk)
    fmt::print("angle random walk {:.6g} {} root s, read from {:.6g} to {:.6g} s\n", walk->coefficient, unit,
               walk->from_s, walk->to_s);
  else
    fmt::print("angle random walk: no stretch of slope -1/2 over a decade, so none is given\n");
  if (const auto& flicker = result.flicker)
    fmt::print("bias instability {:.6g} {}, read from {:.6g} to {:.6g} s\n", flicker->coefficient, unit,
               flicker->from_s, flicker->to_s);
  else
    fmt::print(
        "bias instability: no level stretch of two octaves, so none is given; at most {:.6g} {}, at {:.6g} "
        "s{}\n",
        result.bias_instability, unit, result.bias_instability_tau_s,
        result.bias_instability_is_bound ? ", the longest tau" : "");
  if (const auto& walk = result.rate_random_walk)
    fmt::print("rate random walk {:.6g} {} per root s, read from {:.6g} to {:.6g} s\n", walk->coefficient,
               unit, walk->from_s, walk->to_s);
  else
    fmt::print("rate random walk: no stretch of slope +1/2 over a decade, so none is given\n");
}

int allan(const AllanOptions& options) {
  refuse_settled_points(options.recording);
  refuse_overwriting({options.report}, {options.recording});
  const auto recording = recording::read_recording(options.recording);
  const auto& values = recording.require(options.channel, "the Allan deviation");
  const Eigen::Map<const Eigen::VectorXd> samples(values.data(), static_cast<Eigen::Index>(values.size()));
  const auto stretches = stretches_of(recording, values);
  const double interval_s = 1.0 / recording.sample_rate_hz;
  if (std::ranges::all_of(stretches, [](const auto& stretch) { return stretch.count < 3; })) {
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
      samples, stretches, interval_s,
      options.decades ? calibration::TauSpacing::kDecade : calibration::TauSpacing::kOctave,
      options.separate ? calibration::AllanEstimator::kSeparate : calibration::AllanEstimator::kOverlapping);
  const auto averaged = std::llround(options.average_s / interval_s);
  Eigen::Index averages = 0;
  for (const auto& stretch : stretches) averages += stretch.count / averaged;
  const auto stable =
      averages >= 2
          ? std::optional(calibration::bias_stability(samples, stretches, interval_s, options.average_s))
          : std::nullopt;
  const Eigen::Index used = calibration::total_rows(stretches);
  std::string page;
  if (!options.report.empty())
    page = write_allan_page(options.report, {options.recording, options.channel, unit, recording, interval_s,
                                             result, options.average_s, stable, used, options.separate});
  if (options.json) {
    recording::Json json{{"channel", options.channel},
                         {"unit", unit},
                         {"samples", used},
                         {"stretches", stretches.size()},
                         {"estimator", options.separate ? "separate" : "overlapping"},
                         {"interval_s", interval_s}};
    json.update(as_json(result));
    if (stable) json["bias_stability"] = {{"average_s", options.average_s}, {"value", *stable}};
    if (!page.empty()) json["report"] = page;
    fmt::print("{}\n", recording::json_text(json, 2));
    return exit_good;
  }
  fmt::print("{} Allan deviation of {} [{}], {} of {} samples every {:.6g} s{}\n",
             options.separate ? "separate" : "overlapping", options.channel, unit, used, values.size(),
             interval_s, stretches.size() > 1 ? fmt::format(", in {} stretches", stretches.size()) : "");
  fmt::print("       tau s      deviation    68 % interval             pairs\n");
  for (const auto& p : result.points)
    fmt::print("{:>12.6g} {:>14.6g}    {:<11.6g} {:<11.6g} {:>8}\n", p.tau_s, p.deviation, p.lower, p.upper,
               p.pairs);
  print_terms(result, unit);
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
  auto* command = app.add_subcommand("allan", "Allan deviation, noise terms and bias stability of a channel");
  command->add_option("recording", options->recording, "telemetry, or an output of hemi run")->required();
  command->add_option("-c,--channel", options->channel, "which channel")->capture_default_str();
  command->add_option("--average", options->average_s, "averaging time of the bias stability [s]")
      ->check(positive_number())
      ->capture_default_str();
  command->add_flag("--decades", options->decades, "tau in decades instead of octaves");
  command->add_flag("--separate", options->separate,
                    "averages of the definition, each sample in one pair of them; default: overlapping");
  command->add_option("--report", options->report, report_option_help);
  command->add_flag("--json", options->json, "result as JSON");
  command->footer("Example: hemi allan out.csv --channel compensated_rate_dph");
  command->callback([options, &job] { job = [options] { return allan(*options); }; });
}

}  // namespace hemi::cli

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/diagnose_capture.hpp"
#include "cli/diagnose_case.hpp"
#include "cli/diagnose_report.hpp"
#include "cli/diagnose_table.hpp"
#include "cli/diagnose_telemetry.hpp"
#include "cli/invocation.hpp"
#include "cli/options.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/recording.hpp"
#include "cli/recording/write.hpp"
#include "cli/report/diagnosis_report.hpp"
#include "golden/calibration/linear_fit.hpp"

namespace hemi::cli {
namespace {

namespace fs = std::filesystem;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct DiagnoseOptions {
  std::string recording;
  std::string model;
  std::string telemetry;
  std::optional<double> adc_rate_hz;
  std::string directory = ".";
  double from_s = -kInfinite, to_s = kInfinite;
  std::optional<double> heldout_from_s, heldout_to_s;
  bool json = false;
};

struct Stretch {
  diagnosis::BenchPart part;
  double first_s, last_s;
};

// The longest run of rows between two times without a gap or a missing value.
Stretch longest_stretch(const recording::Recording& recording, double from_s, double to_s) {
  check_stretch(from_s, to_s);
  const auto& time = recording.require("time_s", "the diagnosis");
  const auto& force = recording.find("force_v")->values;
  const auto& displacement = recording.find("displacement_v")->values;
  std::vector<bool> starts(time.size() + 1, false);
  for (const auto& gap : recording.gaps) starts[gap.after_row + 1] = true;
  std::size_t best = 0, best_at = 0, at = 0, inside = 0;
  for (std::size_t i = 0; i <= time.size(); ++i) {
    const bool whole = i < time.size() && time[i] >= from_s && time[i] <= to_s && !std::isnan(force[i]) &&
                       !std::isnan(displacement[i]);
    inside += i < time.size() && time[i] >= from_s && time[i] <= to_s ? 1 : 0;
    if (whole && !starts[i]) continue;
    if (i - at > best) {
      best = i - at;
      best_at = at;
    }
    at = whole ? i : i + 1;
  }
  if (best < 1024)
    throw recording::InputError(
        {.path = recording.path},
        fmt::format("{} rows without a gap from {} s to {} s; 1024 are needed", best, from_s, to_s),
        "record longer, or give another part");
  if (best < inside)
    print_notes({fmt::format("{} of {} rows are used, the longest stretch without a gap", best, inside)});
  const auto rows = static_cast<Eigen::Index>(best);
  return {{Eigen::VectorXd::Map(force.data() + best_at, rows),
           Eigen::VectorXd::Map(displacement.data() + best_at, rows)},
          time[best_at],
          time[best_at + best - 1]};
}

diagnosis::BenchDiagnosis run(const DiagnoseOptions& options, const Stretch& fitted,
                              const std::optional<diagnosis::BenchPart>& other, double rate_hz,
                              const std::optional<diagnosis::BenchPrior>& prior) {
  diagnosis::BenchOptions search;
  search.tick = recording::check_interrupt;
  try {
    return diagnosis::diagnose_bench(fitted.part, other, rate_hz, prior, search);
  } catch (const calibration::RankDeficiencyError& error) {
    throw recording::InputError({.path = options.recording}, error.what(), "record with a force that moves");
  }
}

// Residuals over the rows of the fit, the linear model's and the last one's.
report::ReportSeries series_of(const diagnosis::BenchDiagnosis& result, const Stretch& fitted,
                               double rate_hz) {
  report::ReportSeries series{.channel = "displacement_v", .unit = "V"};
  const auto& before = result.linear.residual;
  const auto& after = result.final.residual;
  for (Eigen::Index i = 0; i < before.size(); ++i)
    series.time_s.push_back(fitted.first_s + static_cast<double>(i) / rate_hz);
  series.before.assign(before.data(), before.data() + before.size());
  series.after.assign(after.data(), after.data() + after.size());
  return series;
}

int diagnose_bench(const DiagnoseOptions& options, const recording::Recording& recording) {
  const std::string json_path = (fs::path(options.directory) / "diagnosis.json").string();
  const std::string model_path = (fs::path(options.directory) / "corrected.model.json").string();
  const std::string page_path = (fs::path(options.directory) / "report.html").string();
  std::vector<std::string> inputs = {options.recording};
  std::optional<diagnosis::BenchPrior> prior;
  recording::InstrumentModel given{.device = recording.device};
  if (!options.model.empty()) {
    inputs.push_back(options.model);
    given = recording::read_model(options.model);
    prior = prior_of(given);
  }
  refuse_overwriting({json_path, model_path}, inputs);
  const Stretch fitted = longest_stretch(recording, options.from_s, options.to_s);
  std::optional<diagnosis::BenchPart> other;
  if (options.heldout_from_s || options.heldout_to_s)
    other = longest_stretch(recording, options.heldout_from_s.value_or(-kInfinite),
                            options.heldout_to_s.value_or(kInfinite))
                .part;
  print_notes(recording.notes);
  const auto result = run(options, fitted, other, recording.sample_rate_hz, prior);
  make_directory(options.directory);
  const recording::Json json =
      to_json(result, {options.recording, options.model, fitted.first_s, fitted.last_s});
  recording::write_model(model_path, corrected_model(result, given));
  recording::write_text(json_path, recording::json_text(json, 2) + "\n");
  report::write_diagnosis_report(page_path, json, {series_of(result, fitted, recording.sample_rate_hz)},
                                 {.command = invocation()});
  if (options.json)
    fmt::print("{}\n", recording::json_text(json, 2));
  else
    fmt::print("{}wrote {}, {}, {}\n", to_text(result), json_path, model_path, page_path);
  return result.verdict == diagnosis::Verdict::consistent ? exit_good : exit_difference;
}

// The kind of recording decides what can be asked of it.
int diagnose(const DiagnoseOptions& options) {
  if (holds_settled_points(options.recording))
    return diagnose_table(
        {.points = options.recording, .directory = options.directory, .json = options.json});
  if (is_capture(options.recording))
    return diagnose_capture({.capture = options.recording,
                             .model = options.model,
                             .telemetry = options.telemetry,
                             .directory = options.directory,
                             .adc_rate_hz = options.adc_rate_hz,
                             .json = options.json});
  const auto recording = recording::read_recording(options.recording);
  if (recording.find("force_v") != nullptr && recording.find("displacement_v") != nullptr)
    return diagnose_bench(options, recording);
  if (holds_telemetry(recording))
    return diagnose_telemetry(recording, {options.model, options.directory, options.json});
  if (holds_case_and_rate(recording)) {
    print_notes(recording.notes);
    return diagnose_case(recording, {.directory = options.directory, .json = options.json});
  }
  throw recording::InputError(
      {.path = options.recording}, "holds nothing that can be diagnosed",
      "give telemetry (frequency_hz, drive_v, ...), rate_dph with case_temp_degc, force_v with "
      "displacement_v, raw samples, or a table of settled points");
}

}  // namespace

void add_diagnose(CLI::App& app, Job& job) {
  auto options = std::make_shared<DiagnoseOptions>();
  auto* command = app.add_subcommand("diagnose", "What an instrument does that its model leaves out");
  command
      ->add_option("recording", options->recording,
                   "telemetry, bench recording (force_v, displacement_v), raw capture or settled points")
      ->required();
  command->add_option(
      "-m,--model", options->model,
      "instrument model; telemetry needs one, for a bench recording a linear one is fitted without it");
  command->add_option("--telemetry", options->telemetry, "records of the same run, beside a raw capture");
  command->add_option("--adc-rate", options->adc_rate_hz, "samples a second of a raw capture [Hz]")
      ->check(positive_number());
  command
      ->add_option("-o,--output", options->directory,
                   "directory for diagnosis.json, corrected.model.json and report.html")
      ->capture_default_str();
  const auto finite = number_between(-1e300, 1e300);
  command->add_option("--from", options->from_s, "start of the part that is fitted [s]")->check(finite);
  command->add_option("--to", options->to_s, "its end [s]")->check(finite);
  command->add_option("--heldout-from", options->heldout_from_s, "start of a part that is only predicted [s]")
      ->check(finite);
  command->add_option("--heldout-to", options->heldout_to_s, "its end [s]")->check(finite);
  command->add_flag("--json", options->json, "diagnosis as JSON on standard output too");
  command->footer(
      "Example: hemi diagnose chamber.csv --model HRG-A17.model.json -o out\n"
      "         hemi diagnose run.raw.csv --telemetry run.csv --model HRG-A17.model.json -o out\n"
      "         hemi diagnose silverbox.csv --from 67.175 --heldout-from 0.164 --heldout-to 66.19 -o out");
  command->callback([options, &job] { job = [options] { return diagnose(*options); }; });
}

}  // namespace hemi::cli

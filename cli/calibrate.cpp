// SPDX-License-Identifier: Apache-2.0
#include "cli/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/pages.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/raw_capture.hpp"
#include "golden/calibration/linear_fit.hpp"

namespace hemi::cli {
namespace {

using recording::InputError;

/// What the numbers of a file do not allow (too few different temperatures, a regressor that does not move)
/// is bad input, told with the file's name.
template <class Work>
void on_data(const std::string& path, Work work) {
  constexpr const char* remedy =
      "check the units, --reference-degc and --reference-hz, or record a wider range";
  try {
    work();
  } catch (const std::invalid_argument& error) {
    throw InputError({path}, error.what(), remedy);
  } catch (const std::domain_error& error) {
    throw InputError({path}, error.what(), remedy);
  } catch (const calibration::RankDeficiencyError& error) {
    throw InputError({path}, error.what(), remedy);
  }
}

std::vector<recording::Recording> read_recordings(const std::vector<std::string>& paths) {
  std::vector<recording::Recording> recordings;
  for (const auto& path : paths) {
    if (recording::is_raw(path)) {
      throw InputError({path}, "is a raw capture, where settled points or a chamber recording are expected",
                       "run it through an engine first: hemi run");
    }
    recordings.push_back(recording::read_recording(path));
    refuse_compensated(recordings.back(), "calibrating");
  }
  return recordings;
}

void calibrate_recordings(const std::vector<std::string>& paths, Calibration& calibration) {
  check_stretch(calibration.options.from_s, calibration.options.to_s);
  const auto recordings = read_recordings(paths);
  for (const auto& recording : recordings)
    if (!recording.device.empty()) calibration.model.device = recording.device;
  on_data(paths.front(), [&] {
    const auto thermal = calibrate_thermal(recordings, calibration);
    const bool any_rate =
        std::ranges::any_of(recordings, [](const auto& r) { return r.find("rate_dph") != nullptr; });
    if (!thermal && !any_rate) recordings.front().require("rate_dph", "a drift model");
    const auto drift = calibrate_bias(recordings, calibration);
    calibrate_channels(recordings, thermal, drift, calibration);
    std::ranges::move(calibration_plots(thermal, drift, calibration), std::back_inserter(calibration.plots));
  });
}

/// Files that are named as an output must not be read as well.
std::vector<std::string> all_inputs(const CalibrateOptions& options) {
  std::vector<std::string> inputs = options.inputs;
  inputs.insert(inputs.end(), options.heldout.begin(), options.heldout.end());
  return inputs;
}

int calibrate(const CalibrateOptions& options) {
  refuse_overwriting({options.output, options.registers, options.report}, all_inputs(options));
  Calibration calibration{options};
  if (!options.base.empty()) calibration.model = recording::read_model(options.base);
  std::vector<std::string> recordings;
  for (const auto& path : options.inputs) {
    if (!holds_settled_points(path))
      recordings.push_back(path);
    else
      on_data(path, [&] {
        calibrate_frequency(path, calibration);
        std::ranges::move(settled_plots(path, calibration), std::back_inserter(calibration.plots));
      });
  }
  if (!recordings.empty()) calibrate_recordings(recordings, calibration);
  score_heldout(calibration);
  if (!options.registers.empty()) write_registers(options.registers, calibration);
  if (!options.output.empty()) {
    recording::write_model(options.output, calibration.model);
    calibration.text += fmt::format("wrote {}\n", options.output);
    calibration.json["model"] = options.output;
  }
  if (!options.report.empty()) {
    const std::string page = write_calibration_page(calibration);
    calibration.text += fmt::format("wrote {}\n", page);
    calibration.json["report"] = page;
  }
  if (options.json)
    fmt::print("{}\n", recording::json_text(calibration.json, 2));
  else
    fmt::print("{}", calibration.text);
  return exit_good;
}

}  // namespace

void Calibration::leave_out(const std::string& part, const std::string& why) {
  text += fmt::format("left out: {}: {}\n", part, why);
  json["left_out"].push_back({{"part", part}, {"why", why}});
}

hemi::calibration::FrequencyPolynomial frequency_polynomial(const recording::InstrumentModel& model) {
  double low = -40.0, high = 85.0;
  if (model.document.contains("frequency") && model.document["frequency"].contains("calibrated_degc")) {
    const auto& range = model.document["frequency"]["calibrated_degc"];
    if (range.is_array() && range.size() == 2 && range[0].is_number() && range[1].is_number()) {
      low = range[0];
      high = range[1];
    }
  }
  const auto& c = model.frequency->coefficients_hz;
  return {Eigen::VectorXd::Map(c.data(), static_cast<Eigen::Index>(c.size())),
          model.frequency->reference_degc, low, high};
}

void add_calibrate(CLI::App& app, Job& job) {
  auto options = std::make_shared<CalibrateOptions>();
  auto* command = app.add_subcommand(
      "calibrate", "Chamber recordings (and settled points) to an instrument model and a register image");
  command
      ->add_option("inputs", options->inputs,
                   "chamber recordings (case_temp_degc, frequency_hz, rate_dph, drive_v, ...) and/or settled "
                   "points (CSV settled_degc,frequency_hz)")
      ->required();
  command->add_option("-o,--output", options->output, "instrument model to write (M.model.json)");
  command->add_option("--heldout", options->heldout, "recordings that are scored and not fitted");
  command->add_option("--registers", options->registers,
                      "register image of the core to write (.json, .h or .mem)");
  command->add_option("--base", options->base, "instrument model to start from");
  command
      ->add_option("--order", options->order,
                   "order of f(T); default: what the points support, with the reasons")
      ->check(CLI::Range(1, 8));
  command
      ->add_option("--reference-degc", options->reference_degc,
                   "temperature that f(T) is expanded about [degC]")
      ->check(number_between(-273.15, 1000.0))
      ->capture_default_str();
  command
      ->add_option("--reference-hz", options->reference_hz,
                   "frequency that the drift model is expanded about [Hz]; default: that at 20 degC")
      ->check(positive_number());
  command->add_option("--from", options->from_s, "start of the stretch to fit [s]");
  command->add_option("--to", options->to_s, "end of it [s]");
  command->add_option("--window", options->window_s, "window of df/dt [s], about; default 20")
      ->check(positive_number());
  command->add_option("--blocks", options->blocks, "contiguous blocks for held-out scores; 0 for none")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--report", options->report, report_option_help);
  command->add_flag("--json", options->json, "result as JSON");
  command->footer(
      "Example: hemi calibrate tests/data/paper_table1.csv --order 3 -o hrg.model.json\n"
      "         hemi calibrate chamber.csv --base hrg.model.json --to 12000 -o hrg.model.json");
  command->callback([options, &job] { job = [options] { return calibrate(*options); }; });
}

}  // namespace hemi::cli

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/engines.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/pages.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/sidecar.hpp"
#include "cli/recording/write.hpp"
#include "cli/run_port.hpp"
#include "cli/summary.hpp"

namespace hemi::cli {
namespace {

struct RunOptions {
  std::string recording;
  std::string port;
  double seconds = 10.0;
  std::string engine = "hls";
  std::string model;
  std::string output;
  std::string report;
  std::optional<double> frequency_hz;
  std::optional<double> window_s;
  std::optional<double> adc_rate_hz;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  bool json = false;
};

recording::Recording with_provenance(recording::Recording out, const RunOptions& options,
                                     const std::string& device) {
  out.device = device;
  out.sidecar["engine"] = options.engine;
  out.sidecar["source"] = options.recording;
  if (!options.model.empty()) out.sidecar["model"] = options.model;
  out.sidecar["compensated"] = !options.model.empty();
  return out;
}

/// The JSON file that goes with the output; HDF5 and MATLAB hold it inside.
std::string sidecar_of_output(const RunOptions& options) {
  std::filesystem::path path = options.output;
  if (path.empty() || recording::output_kind(path) != recording::OutputKind::kCsv) return {};
  return path.replace_extension(".json").string();
}

/// NAME.json may speak of the input as well: NAME.raw.csv or NAME.wav in, NAME.csv out. Its keys stay.
void keep_shared_sidecar(recording::Recording& out, const RunOptions& options) {
  const auto shared = recording::read_sidecar(options.recording);
  std::error_code code;
  if (!shared.exists || !std::filesystem::equivalent(sidecar_of_output(options), shared.path, code)) return;
  for (const auto& [key, value] : shared.content.items()) {
    if (key == "sample_rate_hz" && value != out.sample_rate_hz) {
      throw recording::InputError({shared.path, 0, 0, key},
                                  fmt::format("belongs to {} and differs from the output's {} Hz",
                                              options.recording, out.sample_rate_hz),
                                  "give the output another name");
    }
    if (!out.sidecar.contains(key)) out.sidecar[key] = value;
  }
}

void finish(recording::Recording out, const RunOptions& options, recording::Json summary,
            const std::string& text) {
  if (!options.output.empty()) {
    keep_shared_sidecar(out, options);
    recording::write_file(options.output, out);
  }
  summary["engine"] = options.engine;
  if (!options.output.empty()) summary["output"] = options.output;
  std::string page;
  if (!options.report.empty())
    page = write_run_page(options.report, out, summary, options.recording, options.engine, text);
  if (options.json) {
    if (!page.empty()) summary["report"] = page;
    fmt::print("{}\n", recording::json_text(summary, 2));
  } else {
    fmt::print("{}", text);
    if (!options.output.empty()) fmt::print("wrote {}\n", options.output);
    if (!page.empty()) fmt::print("wrote {}\n", page);
  }
}

int run_capture(const RunOptions& options, const std::optional<recording::InstrumentModel>& model) {
  recording::RawOptions raw;
  raw.sample_rate_hz = options.adc_rate_hz;
  const auto capture = recording::read_raw_capture(options.recording, raw);
  const Setup setup =
      capture_setup(capture, model ? &*model : nullptr, options.frequency_hz, options.window_s);
  require_an_output(capture, setup);
  print_notes(capture.notes);
  print_gaps(capture.gaps);
  print_notes(setup.notes);
  const auto engine = make_engine(options.engine, setup.wide);
  engine->reset(setup.values);
  const auto records = run_samples(*engine, sample_pairs(capture));
  std::vector<double> time_s(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) time_s[i] = output_time_s(i, setup);
  const auto out = with_provenance(to_recording(records, time_s, setup, false), options, capture.device);
  const RunSummary summary = summarise_capture(out, options.from_s, options.to_s);
  finish(out, options, to_json(summary),
         fmt::format("{}: {} sample pairs, {} outputs at {:.6g} Hz\n{}", options.engine, capture.adc_x.size(),
                     records.size(), 1.0 / setup.output_period_s, to_text(summary)));
  return exit_good;
}

/// Standard deviation of the values that are there between the two times.
double deviation(const recording::Recording& out, const char* channel, const RunOptions& options) {
  const auto& time_s = out.find("time_s")->values;
  const auto& values = out.find(channel)->values;
  double n = 0, mean = 0, square = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double v = values[i];
    if (std::isnan(v) || time_s[i] < options.from_s || time_s[i] > options.to_s) continue;
    n += 1;
    const double d = v - mean;
    mean += d / n;
    square += d * (v - mean);
  }
  return n > 1 ? std::sqrt(square / (n - 1)) : 0.0;
}

int run_recording(const RunOptions& options, const std::optional<recording::InstrumentModel>& model) {
  if (!model) {
    throw recording::InputError({options.recording},
                                "telemetry is compensated with an instrument model, and none is given",
                                "give --model M.model.json; hemi calibrate makes one");
  }
  const auto recording = recording::read_recording(options.recording);
  refuse_compensated(recording, "compensating");
  const Setup setup = telemetry_setup(recording.sample_rate_hz, *model, options.window_s);
  const TelemetryInput input = telemetry_input(recording, *model);
  print_notes(input.notes);
  print_gaps(recording.gaps);
  const auto engine = make_engine(options.engine, setup.wide);
  engine->reset(setup.values);
  const auto records = run_telemetry(*engine, input, setup);
  const auto out = with_provenance(telemetry_output(records, input, setup), options, recording.device);
  const double before = deviation(out, "rate_dph", options);
  const double after = deviation(out, "compensated_rate_dph", options);
  recording::Json summary;
  summary["rows"] = records.size();
  summary["rate_deviation_dph"] = before;
  summary["compensated_deviation_dph"] = after;
  summary["derivative_window_s"] = setup.derivative_window_s;
  summary["thermometer_error_degc"] = setup.thermometer_error_degc;
  finish(out, options, summary,
         fmt::format("{}: {} rows; standard deviation of the rate {:.6g} deg/h, compensated {:.6g} deg/h\n"
                     "df/dt over {:.4g} s; thermometer polynomial within {:.2g} degC of f(T)\n",
                     options.engine, records.size(), before, after, setup.derivative_window_s,
                     setup.thermometer_error_degc));
  return exit_good;
}

int run_board(RunOptions options, const std::optional<recording::InstrumentModel>& model) {
  options.engine = "board";
  options.recording = options.port;
  const PortRun run = run_port({options.port, options.seconds, options.frequency_hz, options.window_s},
                               model ? &*model : nullptr);
  std::vector<double> time_s(run.records.size());
  for (std::size_t i = 0; i < time_s.size(); ++i) time_s[i] = output_time_s(i, run.setup);
  auto out = with_provenance(to_recording(run.records, time_s, run.setup, false), options,
                             model ? model->device : std::string());
  for (const auto& fault : run.faults) fmt::print(stderr, "note: {}: {}\n", options.port, fault);
  if (!run.faults.empty()) out.sidecar["board_faults"] = run.faults;
  const RunSummary summary = summarise_capture(out, options.from_s, options.to_s);
  recording::Json json = to_json(summary);
  json["board_faults"] = run.faults;
  finish(out, options, json,
         fmt::format("{}: {} records at {:.6g} Hz\n{}", options.port, run.records.size(),
                     1.0 / run.setup.output_period_s, to_text(summary)));
  return exit_good;
}

int run(const RunOptions& options) {
  check_engine_name(options.engine);
  check_stretch(options.from_s, options.to_s);
  if (options.port.empty()) refuse_settled_points(options.recording);
  if (std::filesystem::path(options.output).extension() == ".json") {
    throw recording::OutputError(options.output, "the ending belongs to the file beside an output",
                                 "name the output .csv, .h5 or .mat");
  }
  refuse_overwriting({options.output, sidecar_of_output(options)}, {options.recording, options.model});
  if (options.port.empty())
    refuse_overwriting({options.output}, {recording::read_sidecar(options.recording).path});
  std::optional<recording::InstrumentModel> model;
  if (!options.model.empty()) model = recording::read_model(options.model);
  if (!options.port.empty()) return run_board(options, model);
  if (recording::is_raw(options.recording)) return run_capture(options, model);
  return run_recording(options, model);
}

}  // namespace

void add_run(CLI::App& app, Job& job) {
  auto options = std::make_shared<RunOptions>();
  auto* command =
      app.add_subcommand("run", "A recording through one engine: frequency, temperature, compensated rate");
  auto* recording = command->add_option(
      "recording", options->recording,
      "raw capture (adc_x, adc_y; CSV, HDF5, MATLAB, WAV, FLAC) or telemetry (frequency_hz, rate_dph)");
  auto* port =
      command
          ->add_option("--port", options->port,
                       "instead of a recording: serial line of the reference design, such as /dev/ttyUSB1")
          ->excludes(recording);
  command->add_option("--seconds", options->seconds, "how long to record from --port; default 10")
      ->check(positive_number())
      ->needs(port);
  command->add_option("-e,--engine", options->engine, "ideal, golden, hls, rtl or systemc")
      ->capture_default_str();
  command->add_option("-m,--model", options->model, "instrument model (hemi-model/1)");
  command->add_option("-o,--output", options->output, "output: .csv, .h5 for HDF5, or .mat for MATLAB");
  command
      ->add_option("-f,--frequency", options->frequency_hz,
                   "where the nco starts [Hz]; default: the model's at 20 degC")
      ->check(positive_number());
  command->add_option("--window", options->window_s, "window of df/dt [s], about; default 20")
      ->check(positive_number());
  command
      ->add_option("--adc-rate", options->adc_rate_hz,
                   "ADC rate of a capture that does not say it [samples/s]")
      ->check(positive_number());
  command->add_option("--from", options->from_s, "start of the stretch that the summary speaks of [s]");
  command->add_option("--to", options->to_s, "end of it [s]");
  command->add_option("--report", options->report, report_option_help);
  command->add_flag("--json", options->json, "summary as JSON");
  command->footer("Example: hemi run bell.wav --engine rtl --frequency 3621 --from 0.5 --to 2.5 -o bell.csv");
  command->callback([options, &job] {
    if (options->recording.empty() && options->port.empty()) throw CLI::RequiredError("recording");
    job = [options] { return run(*options); };
  });
}

}  // namespace hemi::cli

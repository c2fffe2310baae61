// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/installed.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/write.hpp"
#include "cli/scenario/run.hpp"
#include "cli/scenario/wav_write.hpp"

namespace hemi::cli {
namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  std::string scenario;
  std::string directory = ".";
  std::optional<std::uint64_t> seed;
  bool hdf5 = false;
  bool matlab = false;
  bool truth = false;
  bool json = false;
};

/// Paths of all files of a run; empty for those that it does not write.
struct Outputs {
  std::string telemetry;
  std::string sidecar;
  std::string model;
  std::string raw;
  std::string truth;

  std::vector<std::string> all() const {
    std::vector<std::string> paths;
    for (const auto& path : {telemetry, sidecar, raw, model, truth}) {
      if (!path.empty()) paths.push_back(path);
    }
    return paths;
  }
};

Outputs outputs_of(const scenario::Scenario& scenario, const SimulateOptions& options) {
  const std::string stem = (fs::path(options.directory) / scenario.name).string();
  Outputs outputs;
  outputs.telemetry = stem + (options.hdf5 ? ".h5" : options.matlab ? ".mat" : ".csv");
  const bool raw_needs_sidecar = scenario.raw && scenario.raw->format == "csv";
  if (recording::output_kind(outputs.telemetry) == recording::OutputKind::kCsv || raw_needs_sidecar)
    outputs.sidecar = stem + ".json";
  outputs.model = stem + ".model.json";
  if (scenario.raw) outputs.raw = fmt::format("{}.raw.{}", stem, scenario.raw->format);
  if (options.truth) outputs.truth = stem + ".truth.json";
  return outputs;
}

recording::Json truth_of(const scenario::Scenario& scenario) {
  recording::Json truth = {{"name", scenario.name}, {"scenario", scenario.path}, {"seed", scenario.seed}};
  truth["effects"] = recording::Json::array();
  for (const auto& effect : scenario.effects) {
    recording::Json parameters = recording::Json::object();
    for (const auto& [name, value] : effect.values) parameters[name] = value;
    truth["effects"].push_back({{"id", effect.id}, {"parameters", parameters}});
  }
  return truth;
}

/// The directory, made where its parent is there.
void require_directory(const std::string& directory) {
  std::error_code code;
  if (fs::is_directory(directory, code)) return;
  if (fs::exists(directory, code)) {
    throw recording::OutputError(directory, "is no directory", "name a directory, or a new one");
  }
  fs::create_directory(directory, code);
  if (code) throw recording::OutputError(directory, code.message(), "make the directory above it first");
}

void write_raw(const std::string& path, const recording::RawCapture& capture) {
  if (fs::path(path).extension() == ".wav")
    scenario::write_wav(path, capture);
  else
    recording::write_file(path, capture);
}

// The telemetry comes last: its sidecar speaks of the raw capture as well, and who finds it finds all of
// them.
void write_all(const scenario::Scenario& scenario, const scenario::Simulated& simulated,
               const Outputs& outputs) {
  require_directory(fs::path(outputs.telemetry).parent_path().string());
  recording::write_model(outputs.model, scenario.nominal_model());
  if (!outputs.truth.empty())
    recording::write_text(outputs.truth, recording::json_text(truth_of(scenario), 2) + "\n");
  if (simulated.raw) write_raw(outputs.raw, *simulated.raw);
  recording::write_file(outputs.telemetry, to_recording(simulated, scenario));
}

void report(const scenario::Scenario& scenario, const Outputs& outputs, const SimulateOptions& options,
            std::size_t rows) {
  if (options.json) {
    recording::Json summary = {{"name", scenario.name},
                               {"rows", rows},
                               {"duration_s", scenario.duration_s},
                               {"telemetry_rate_hz", scenario.telemetry_rate_hz},
                               {"effects", scenario.effects.size()},
                               {"files", outputs.all()}};
    fmt::print("{}\n", recording::json_text(summary, 2));
    return;
  }
  std::string files;
  for (const auto& path : outputs.all()) files += (files.empty() ? "" : ", ") + path;
  fmt::print("{}: {:g} s, {} rows at {:g} Hz, {} effects; wrote {}\n", scenario.name, scenario.duration_s,
             rows, scenario.telemetry_rate_hz, scenario.effects.size(), files);
}

int simulate(const SimulateOptions& options) {
  scenario::Scenario scenario = scenario::read_scenario(find_scenario(options.scenario));
  if (options.seed) scenario.seed = *options.seed;
  const Outputs outputs = outputs_of(scenario, options);
  std::vector<std::string> inputs = {scenario.path};
  if (!scenario.model_path.empty()) inputs.push_back(scenario.model_path);
  refuse_overwriting(outputs.all(), inputs);
  const scenario::Simulated simulated =
      scenario.mode == scenario::Mode::full ? simulate_full(scenario) : simulate_slow(scenario);
  recording::check_interrupt();
  print_notes(simulated.notes);
  write_all(scenario, simulated, outputs);
  report(scenario, outputs, options, simulated.telemetry.size());
  return exit_good;
}

}  // namespace

void add_simulate(CLI::App& app, Job& job) {
  auto options = std::make_shared<SimulateOptions>();
  auto* command = app.add_subcommand("simulate", "A scenario to a recording and its instrument model");
  command
      ->add_option("scenario", options->scenario,
                   "scenario (TOML), or the name of one that comes with hemi; docs/scenarios.md has all keys")
      ->required();
  command->add_option("-o,--output", options->directory, "directory for the files; made if need be")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "seed of the noise; goes before the scenario's");
  auto* hdf5 =
      command->add_flag("--hdf5", options->hdf5, "telemetry as NAME.h5 instead of NAME.csv and NAME.json");
  command->add_flag("--matlab", options->matlab, "telemetry as NAME.mat")->excludes(hdf5);
  command->add_flag("--truth", options->truth, "the effects that were at work, as NAME.truth.json");
  command->add_flag("--json", options->json, "summary as JSON");
  command->footer("Example: hemi simulate cycles -o runs --truth");
  command->callback([options, &job] { job = [options] { return simulate(*options); }; });
}

}  // namespace hemi::cli

// SPDX-License-Identifier: Apache-2.0
// hemi export: the register image of a model, for firmware, logic and simulation.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "cli/calibrate.hpp"
#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/write.hpp"
#include "cli/register_image.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

struct ExportOptions {
  std::string model;
  std::string format;
  std::string output;
  std::optional<double> window_s;
  bool open_loop = false;
  bool json = false;
};

/// As `hemi run` sets the core for a recorded capture: samples that answer to no actuator.
Setup replay_setup(const recording::InstrumentModel& model, std::optional<double> window_s) {
  const Sampling reference = sampling(false);
  recording::RawCapture nominal;
  nominal.sample_rate_hz = reference.adc_rate_hz;
  nominal.full_scale_lsb = std::ldexp(1.0, reference.adc_bits - 1);
  return capture_setup(nominal, &model, std::nullopt, window_s);
}

std::string text_of(const tb::RegisterImage& image, const Setup& setup, const ExportOptions& options,
                    const std::string& device) {
  if (options.json) return image_as_json(image, setup.values, device);
  if (options.format == "c") return image_as_c(image, device);
  return options.format == "sv" ? image_as_systemverilog(image, device) : image_as_memory(image);
}

int export_image(const ExportOptions& options) {
  if (options.format.empty() && !options.json)
    throw recording::InputError({}, "no form of register image is named",
                                "give --format c, sv or mem, or --json");
  refuse_overwriting({options.output}, {options.model});
  const auto model = recording::read_model(options.model);
  if (!model.frequency) {
    throw recording::InputError({options.model, 0, 0, "frequency"}, "is missing: a register image needs f(T)",
                                "calibrate f(T) first: hemi calibrate");
  }
  const Setup setup =
      options.open_loop ? replay_setup(model, options.window_s) : core_setup(model, options.window_s);
  const auto image = tb::to_image(setup.values);
  const std::string text = text_of(image, setup, options, model.device);
  if (options.output.empty())
    fmt::print("{}", text);
  else
    recording::write_text(options.output, text);
  return exit_good;
}

}  // namespace

void add_export(CLI::App& app, Job& job) {
  auto options = std::make_shared<ExportOptions>();
  auto* command =
      app.add_subcommand("export", "The core's registers for a model: C, SystemVerilog, $readmemh");
  command->add_option("model", options->model, "instrument model (hemi-model/1)")->required();
  auto* format =
      command
          ->add_option("--format", options->format,
                       "c: array for C99 and C++; sv: SystemVerilog package; mem: words for $readmemh")
          ->check(CLI::IsMember({"c", "sv", "mem"}));
  command->add_flag("--json", options->json, "each register with value, unit, raw word and meaning, as JSON")
      ->excludes(format);
  command->add_option("-o,--output", options->output, "file; default: standard output");
  command->add_option("--window", options->window_s, "window of df/dt [s], about; default 20")
      ->check(positive_number());
  command->add_flag("--open-loop", options->open_loop,
                    "for recorded samples, as hemi run sets the core; default: actuators in closed loop");
  command->footer("Example: hemi export hrg.model.json --format mem -o hrg.mem");
  command->callback([options, &job] { job = [options] { return export_image(*options); }; });
}

}  // namespace hemi::cli

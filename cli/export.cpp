// SPDX-License-Identifier: Apache-2.0
// hemi export: the register image of a model, for firmware, logic and simulation.
#include <fmt/format.h>

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
};

int export_image(const ExportOptions& options) {
  refuse_overwriting({options.output}, {options.model});
  const auto model = recording::read_model(options.model);
  if (!model.frequency) {
    throw recording::InputError({options.model, 0, 0, "frequency"}, "is missing: a register image needs f(T)",
                                "calibrate f(T) first: hemi calibrate");
  }
  const Setup setup = core_setup(model, options.window_s);
  const auto image = tb::to_image(setup.values);
  const std::string text = options.format == "c"    ? image_as_c(image, model.device)
                           : options.format == "sv" ? image_as_systemverilog(image, model.device)
                                                    : image_as_memory(image);
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
  command
      ->add_option("--format", options->format,
                   "c: array for C99 and C++; sv: SystemVerilog package; mem: words for $readmemh")
      ->required()
      ->check(CLI::IsMember({"c", "sv", "mem"}));
  command->add_option("-o,--output", options->output, "file; default: standard output");
  command->add_option("--window", options->window_s, "window of df/dt [s], about; default 20")
      ->check(positive_number());
  command->footer("Example: hemi export hrg.model.json --format mem -o hrg.mem");
  command->callback([options, &job] { job = [options] { return export_image(*options); }; });
}

}  // namespace hemi::cli

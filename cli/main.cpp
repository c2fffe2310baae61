// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "cli/commands.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "tb/registers.hpp"

// SystemC's library has a main of its own, which would call this; ours goes before it.
extern "C" int sc_main(int, char**) {
  return 0;
}

int main(int argc, char** argv) {
  using namespace hemi;
  CLI::App app{"hemi: signal core, simulation and calibration of hemispherical resonator gyros"};
  app.require_subcommand(1);
  app.set_version_flag("--version", HEMI_VERSION);
  app.footer(
      "Exit codes: 0 good, 1 difference found, 2 bad input, 3 internal error, 130 interrupted.\n"
      "hemi COMMAND --help shows the options of a command, with an example.");
  cli::Job job;
  cli::add_run(app, job);
  cli::add_compare(app, job);
  cli::add_calibrate(app, job);
  cli::add_allan(app, job);
  cli::add_info(app, job);
  cli::add_bench(app, job);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? cli::exit_good : cli::exit_bad_input;
  }
  recording::install_interrupt_handler();
  try {
    return job();
  } catch (const recording::Interrupted&) {
    fmt::print(stderr, "hemi: interrupted; nothing half-written is left\n");
    return recording::kInterruptedExitCode;
  } catch (const recording::InputError& error) {
    fmt::print(stderr, "hemi: {}\n", error.what());
  } catch (const recording::OutputError& error) {
    fmt::print(stderr, "hemi: {}\n", error.what());
  } catch (const tb::FormatError& error) {
    fmt::print(stderr, "hemi: {}; rescale the model or the data\n", error.what());
  } catch (const std::exception& error) {
    fmt::print(stderr, "hemi: internal error: {}\n", error.what());
    return cli::exit_internal;
  }
  return cli::exit_bad_input;
}

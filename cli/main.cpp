// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <system_error>

#include "cli/commands.hpp"
#include "cli/invocation.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "golden/calibration/input_error.hpp"

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
  cli::set_invocation(argc, argv);
  cli::add_run(app, job);
  cli::add_compare(app, job);
  cli::add_calibrate(app, job);
  cli::add_allan(app, job);
  cli::add_info(app, job);
  cli::add_bench(app, job);
  cli::add_simulate(app, job);
  cli::add_effects(app, job);
  cli::add_diagnose(app, job);
  cli::add_report(app, job);
  cli::add_export(app, job);
  cli::add_prove(app, job);
  cli::add_doctor(app, job);
  cli::add_completion(app, job);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    // Before help is printed: hemi WRONG --help would get the program's own, and exit code 0.
    if (chosen.empty() && argc > 1 && argv[1][0] != '-') {
      fmt::print(stderr, "hemi: no command '{}'; hemi --help lists them\n", argv[1]);
      return cli::exit_bad_input;
    }
    if (error.get_exit_code() == 0) return app.exit(error);
    fmt::print(stderr, "hemi: {}; see hemi {}--help\n", error.what(),
               chosen.empty() ? "" : chosen.front()->get_name() + " ");
    return cli::exit_bad_input;
  }
  recording::install_interrupt_handler();
  try {
    const int code = job();
    // What is still buffered would be lost without a word at exit.
    if (std::fflush(stdout) != 0)
      throw recording::OutputError("standard output", std::strerror(errno), "free some space");
    return code;
  } catch (const recording::Interrupted&) {
    fmt::print(stderr, "hemi: interrupted; nothing half-written is left\n");
    return recording::kInterruptedExitCode;
  } catch (const recording::InputError& error) {
    fmt::print(stderr, "hemi: {}\n", error.what());
  } catch (const recording::OutputError& error) {
    fmt::print(stderr, "hemi: {}\n", error.what());
  } catch (const calibration::InputError& error) {
    fmt::print(stderr, "hemi: {}\n", error.what());
  } catch (const std::system_error& error) {
    fmt::print(stderr, "hemi: standard output: {}; free some space\n", error.code().message());
  } catch (const std::exception& error) {
    fmt::print(stderr, "hemi: internal error: {}\n", error.what());
    return cli::exit_internal;
  }
  return cli::exit_bad_input;
}

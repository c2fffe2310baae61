// SPDX-License-Identifier: Apache-2.0
// The program's subcommands: each adds itself to the parser and, when chosen, sets `job`.
#ifndef HEMI_CLI_COMMANDS_HPP
#define HEMI_CLI_COMMANDS_HPP

#include <CLI/CLI.hpp>
#include <functional>

namespace hemi::cli {

// Exit codes of the program; recording::kInterruptedExitCode ends an interrupted one.
inline constexpr int exit_good = 0;
inline constexpr int exit_difference = 1;  ///< engines differ, a misfit was found
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_internal = 3;

/// What the chosen subcommand does; returns an exit code.
using Job = std::function<int()>;

void add_run(CLI::App& app, Job& job);
void add_compare(CLI::App& app, Job& job);
void add_calibrate(CLI::App& app, Job& job);
void add_allan(CLI::App& app, Job& job);
void add_info(CLI::App& app, Job& job);
void add_bench(CLI::App& app, Job& job);
void add_simulate(CLI::App& app, Job& job);
void add_effects(CLI::App& app, Job& job);
void add_diagnose(CLI::App& app, Job& job);
void add_report(CLI::App& app, Job& job);
void add_export(CLI::App& app, Job& job);
void add_prove(CLI::App& app, Job& job);
void add_doctor(CLI::App& app, Job& job);
void add_completion(CLI::App& app, Job& job);

}  // namespace hemi::cli

#endif  // HEMI_CLI_COMMANDS_HPP

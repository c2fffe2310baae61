// SPDX-License-Identifier: Apache-2.0
// Completion for shells, made from the parser itself: whatever an option is called, it is completed so.
#ifndef HEMI_CLI_COMPLETION_HPP
#define HEMI_CLI_COMPLETION_HPP

#include <CLI/CLI.hpp>
#include <string>

namespace hemi::cli {

/// Scripts for the program `hemi` with the subcommands and options of `app`. Options that take one of a few
/// words complete these; those that take numbers, nothing; all others, files.
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);

}  // namespace hemi::cli

#endif  // HEMI_CLI_COMPLETION_HPP

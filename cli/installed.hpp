// SPDX-License-Identifier: Apache-2.0
// Files that come with the program.
#ifndef HEMI_CLI_INSTALLED_HPP
#define HEMI_CLI_INSTALLED_HPP

#include <filesystem>
#include <string>
#include <vector>

namespace hemi::cli {

/// share/hemi beside the program's own directory (an installed one) or in it (one in a build directory);
/// empty where neither is there.
std::filesystem::path share_directory();

/// Names of the scenarios that come with the program, sorted.
std::vector<std::string> shipped_scenarios();

/// The file of that name (a directory is none), else the shipped scenario of that name, with or without
/// .toml. InputError with the names where it is neither.
std::string find_scenario(const std::string& name);

}  // namespace hemi::cli

#endif  // HEMI_CLI_INSTALLED_HPP

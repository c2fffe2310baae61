// SPDX-License-Identifier: Apache-2.0
#include "cli/installed.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/recording/error.hpp"

namespace hemi::cli {

namespace fs = std::filesystem;

fs::path share_directory() {
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (code) return {};
  const fs::path here = program.parent_path();
  for (const fs::path& share : {here.parent_path() / "share/hemi", here / "share/hemi"}) {
    if (fs::is_directory(share, code)) return share;
  }
  return {};
}

std::vector<std::string> shipped_scenarios() {
  std::vector<std::string> names;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(share_directory() / "scenarios", code)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string find_scenario(const std::string& name) {
  std::error_code code;
  if (fs::exists(name, code) && !fs::is_directory(name, code)) return name;
  const auto names = shipped_scenarios();
  const fs::path path(name);
  const bool bare = !path.has_parent_path() && (path.extension() == ".toml" || !path.has_extension());
  if (bare && std::find(names.begin(), names.end(), path.stem().string()) != names.end())
    return (share_directory() / "scenarios" / (path.stem().string() + ".toml")).string();
  throw recording::InputError(
      {name}, "No such file, and no scenario of that name comes with hemi",
      names.empty() ? "name a scenario (TOML)"
                    : fmt::format("name a scenario (TOML), or one of {}", fmt::join(names, ", ")));
}

}  // namespace hemi::cli

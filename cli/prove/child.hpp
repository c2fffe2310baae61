// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_CLI_PROVE_CHILD_HPP
#define HEMI_CLI_PROVE_CHILD_HPP

#include <string>
#include <vector>

namespace hemi::prove {

struct ChildLimits {
  double seconds = 120.0;
  double memory_mib = 2048.0;  ///< address space; 0: none
};

struct ChildResult {
  std::string failure{};  ///< empty: exit code 0 or 1
  double seconds = 0.0;
  double peak_mib = 0.0;  ///< largest resident set
};

/// Runs a program to its end with stdin and stdout at /dev/null and stderr in `log`. Its own process group;
/// it dies with this process, at the limit of time, and when this process is interrupted (then Interrupted is
/// thrown). std::system_error where it cannot be started.
ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments,
                      const std::string& log, const ChildLimits& limits);

}  // namespace hemi::prove

#endif  // HEMI_CLI_PROVE_CHILD_HPP

// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_CLI_PROVE_REPORT_HPP
#define HEMI_CLI_PROVE_REPORT_HPP

#include <map>
#include <string>

#include "cli/prove/score.hpp"
#include "cli/recording/json.hpp"

namespace hemi::prove {

struct Report {
  std::string command{}, machine{}, date{};
  double seconds = 0.0;
  std::uint64_t seed = 0;
  int recordings = 0;
  const Score* own = nullptr;
  std::map<std::string, Score> rivals{};
};

recording::Json to_json(const Report& report);

/// Table with target and interval a row, the rivals beside it; confusion matrix; failures one by one.
std::string to_markdown(const Report& report);

/// All rows of `own` at target.
bool all_held(const Report& report);

}  // namespace hemi::prove

#endif  // HEMI_CLI_PROVE_REPORT_HPP

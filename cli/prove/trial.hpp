// SPDX-License-Identifier: Apache-2.0
// One recording of the proof: conceal, diagnose, open the truth.
#ifndef HEMI_CLI_PROVE_TRIAL_HPP
#define HEMI_CLI_PROVE_TRIAL_HPP

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/prove/answer.hpp"
#include "cli/prove/child.hpp"

namespace hemi::prove {

struct Task {
  std::string cls{};
  std::uint64_t index = 0;
  std::string name{};  ///< of the files; tells nothing
};

/// `total` recordings in the proportions of concealed::classes(), at least one a class, or all of one class.
/// InputError for a class that is none.
std::vector<Task> plan(int total, const std::string& only_class);

struct TrialOptions {
  std::uint64_t seed = 1;
  std::string program{};    ///< called as PROGRAM [diagnose] RECORDING --model M -o DIR
  bool own_program = true;  ///< with the word `diagnose`
  ChildLimits limits{};
  std::string directory{};  ///< of recordings and answers
  std::string keep{};       ///< not empty: recordings, answers and truths are moved here
  bool rivals = false;
};

struct Trial {
  Truth truth{};
  Answer answer{};
  std::map<std::string, Answer> rivals{};  ///< by method
  /// Of an ambiguous answer whose set holds the truth and that proposes an experiment: what is said of the
  /// same instrument in that experiment.
  std::optional<Answer> experiment{};
};

Trial run_trial(const Task& task, const TrialOptions& options);

/// All tasks, `jobs` at a time; `done` is called in the order of completion, never twice at once. The first
/// exception of a trial ends all.
void run_trials(const std::vector<Task>& tasks, const TrialOptions& options, unsigned jobs,
                const std::function<void(std::size_t task, Trial&&)>& done);

}  // namespace hemi::prove

#endif  // HEMI_CLI_PROVE_TRIAL_HPP

// SPDX-License-Identifier: Apache-2.0
// Answers against truths: docs/prove.md has the rules in words.
#ifndef HEMI_CLI_PROVE_SCORE_HPP
#define HEMI_CLI_PROVE_SCORE_HPP

#include <map>
#include <string>
#include <vector>

#include "cli/prove/figures.hpp"

namespace hemi::prove {

/// One figure of the proof.
struct Row {
  std::string key{}, text{};
  double value = 0.0, low = 0.0, high = 0.0;  ///< with its 95 % interval
  int trials = 0;                             ///< 0: nothing to measure it on
  std::string target{};                       ///< empty: shown for information
  bool held = true;
};

/// A recording whose answer is not the right one for its class.
struct Failure {
  std::string name{}, cls{}, scenario{}, truth{}, answer{}, why{};
  double dprime = 0.0;
};

/// Whether the answer is right for the truth's class; `why` not, in words, where it is not.
bool right(const Truth& truth, const Answer& answer, std::string& why);

/// The truth is the first name, or, where no recording can tell it from its equivalents, among the
/// candidates.
bool right_first(const Truth& truth, const Answer& answer);

/// Whether the experiment of a poor run has told the truth from its rivals: the effect in question named, no
/// other but what was there. Where it is one of two that no recording tells apart, those two alone left over.
bool resolves(const Truth& truth, const Answer& answer);

class Score {
 public:
  void add(const Truth& truth, const Answer& answer);
  /// An ambiguity's proposed experiment was carried out; what is said of it.
  void add_experiment(const Truth& truth, const Answer& answer);
  std::vector<Row> rows() const;
  const std::vector<Failure>& failures() const { return failures_; }
  /// Truth's label -> what was said -> count.
  const std::map<std::string, std::map<std::string, int>>& confusion() const { return confusion_; }
  /// By class: right answers.
  const std::map<std::string, Rate>& by_class() const { return by_class_; }
  /// Probability of each first name, and whether it was right.
  const std::vector<std::pair<double, bool>>& stated() const { return stated_; }
  double longest_s() const { return longest_s_; }
  double peak_mib() const { return peak_mib_; }

 private:
  void add_names(const Truth& truth, const Answer& answer);
  void add_parameters(const Truth& truth, const Answer& answer);
  void add_improvement(const Truth& truth, const Answer& answer);
  void add_place(const Truth& truth, const Answer& answer);

  Rate null_named_{}, params_named_{}, confounder_named_{}, null_unknown_{};
  Rate strong_{}, moderate_{}, wrong_names_{}, weak_silent_{}, unknown_{}, unknown_named_{}, pairs_{},
      poor_{};
  Rate sets_with_truth_{}, covered_{}, answered_{}, experiments_{};
  std::vector<double> errors_{}, closed_{}, overlaps_{}, on_truth_{};
  std::vector<std::pair<double, bool>> stated_{};
  std::vector<Failure> failures_{};
  std::map<std::string, std::map<std::string, int>> confusion_{};
  std::map<std::string, Rate> by_class_{};
  double longest_s_ = 0.0, peak_mib_ = 0.0;
};

}  // namespace hemi::prove

#endif  // HEMI_CLI_PROVE_SCORE_HPP

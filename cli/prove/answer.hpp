// SPDX-License-Identifier: Apache-2.0
// The two files that are laid side by side: what a diagnosis says, and what was concealed.
#ifndef HEMI_CLI_PROVE_ANSWER_HPP
#define HEMI_CLI_PROVE_ANSWER_HPP

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/recording/json.hpp"

namespace hemi::prove {

using Stretches = std::vector<std::pair<double, double>>;

struct Parameter {
  double value = 0.0;
  double low = 0.0, high = 0.0;  ///< ci95
};

struct Named {
  std::string id{};
  std::optional<double> probability{};
  std::map<std::string, Parameter> parameters{};
};

struct Located {
  std::string channel{};
  Stretches time_s{};
  std::optional<std::pair<double, double>> band_hz{};
};

struct Misfit {
  double before_rms = 0.0, after_rms = 0.0, floor_rms = 0.0;
};

/// A diagnosis.json, or what a rival method says.
struct Answer {
  std::string failure{};  ///< not empty: no answer, and why
  std::string verdict{};
  std::vector<Named> effects{};
  std::vector<std::string> alternatives{};
  std::vector<Located> located{};
  std::map<std::string, Misfit> heldout{};  ///< by channel
  bool names_only = false;  ///< of a method that states neither probabilities nor places nor gains
  double seconds = 0.0;
  double peak_mib = 0.0;

  /// Names it stands for: the effects of `named`, and those of `ambiguous` that are not among the
  /// alternatives; never `unknown`.
  std::vector<std::string> names() const;
  /// The candidates of `ambiguous`.
  std::vector<std::string> candidates() const;
  /// Whether it claims physics by name: `named`, or `ambiguous`.
  bool claims() const;
  const Named* find(const std::string& id) const;
};

bool among(const std::vector<std::string>& ids, const std::string& id);

/// Throws std::runtime_error with the reason where the document is no hemi-diagnosis/1.
Answer parse_answer(const recording::Json& document);

struct HiddenTruth {
  std::string id{}, channel{};
  double dprime = 0.0;
  std::map<std::string, double> parameters{};
};

struct Truth {
  std::string name{}, cls{}, scenario{};
  double dprime = 0.0;
  std::vector<HiddenTruth> effects{};
  std::vector<std::string> set{}, tolerated{}, changed{}, confounders{};
  std::vector<Located> located{};  ///< by falling share
  std::map<std::string, double> noise_rms{};

  bool holds(const std::string& id) const;
  /// Label in the confusion matrix.
  std::string label() const;
};

/// Of truth_json(); throws recording::Json exceptions where keys are missing.
Truth parse_truth(const recording::Json& document);

}  // namespace hemi::prove

#endif  // HEMI_CLI_PROVE_ANSWER_HPP

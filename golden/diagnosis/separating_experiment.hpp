// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "golden/diagnosis/expected_gaps.hpp"

namespace hemi::diagnosis {

/// Standard deviations (a gap g scatters by 2 sqrt(g)) by which a gap has to leave kNameMargin: in 99 of 100
/// runs it then does.
inline constexpr double kSureBy = 2.3263478740408408;

/// Gap g with g - kSureBy 2 sqrt(g) = kNameMargin where forms are exact (39.2), doubled since they are not.
double enough_gap();

struct SeparatingExperiment {
  std::optional<Experiment> experiment;  ///< none: nothing tried separates any pair
  Stand stand;
  std::vector<ExpectedGap> gaps;         ///< between alternatives, in this experiment
  std::vector<ExpectedGap> inseparable;  ///< pairs of alternatives that nothing tried separates; largest gaps
  bool enough = false;                   ///< every one of `gaps` is enough_gap() at least
  std::size_t tried = 0;
};

struct ExperimentOptions {
  std::function<void(double share)> tick = [](double) {};  ///< called between experiments; may throw
};

/// The experiment of the least effort (its length, an hour more for each stimulus) that separates all pairs
/// that any can separate, or the one that comes nearest to it. Nothing where the diagnosis has no
/// alternatives with a trace, or no pair can be separated.
std::optional<SeparatingExperiment> find_separating_experiment(const TelemetryDiagnosis& diagnosis,
                                                               const NominalModel& model,
                                                               const ExperimentOptions& options = {});

}  // namespace hemi::diagnosis

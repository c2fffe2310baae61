// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "golden/diagnosis/alternatives.hpp"
#include "golden/diagnosis/experiment.hpp"

namespace hemi::diagnosis {

/// Expected score gap: how much worse the best fit of `rival` would be than that of `truth`, if an experiment
/// were carried out on an instrument with `truth`. Rival empty: nothing left out at all.
struct ExpectedGap {
  std::string truth, rival;
  double gap = 0.0;
  bool alternative = false;  ///< the rival is one of the diagnosis's own alternatives
};

/// Expected gaps of all truths of all sets against every effect of the catalogue that the experiment could
/// show.
///
///     gap = min over rival's forms, shapes, strengths and the nominal model's parameters of |L (y - y_r)|^2
///           + price of the rival - price of the truth,   y the noise-free outputs with the truth at work
///
/// L whitens by the noise that the recording had (white parts by the length of a row, the thermometer's by
/// f'(T) of the new run); prices are the diagnosis's own; the truth is two standard errors weaker than
/// fitted.
std::vector<ExpectedGap> expected_gaps(const Experiment& experiment, const Stand& stand,
                                       const NominalModel& model, const TelemetryDiagnosis& diagnosis,
                                       const std::vector<AlternativeSet>& sets);

/// A gap that leaves kNameMargin with a probability of 99 % where forms are exact (a gap g scatters by 2
/// sqrt(g): g = 39), doubled since they are not.
inline constexpr double kEnoughGap = 78.0;

struct SeparatingExperiment {
  std::optional<Experiment> experiment;  ///< none: nothing tried separates any pair
  Stand stand;
  std::vector<ExpectedGap> gaps;         ///< between alternatives, in this experiment
  std::vector<ExpectedGap> inseparable;  ///< pairs of alternatives that nothing tried separates; largest gaps
  bool enough = false;                   ///< every one of `gaps` is kEnoughGap at least
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

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "golden/diagnosis/alternatives.hpp"
#include "golden/diagnosis/experiment.hpp"

namespace hemi::diagnosis {

/// Expected score gap: how much worse the best fit of `rival` would be than that of `truth`, if an experiment
/// were carried out on an instrument with `truth`. Rival empty: nothing left out at all.
struct ExpectedGap {
  std::string truth, rival;
  double gap = 0.0;
  bool alternative = false;  ///< the rival is one of the diagnosis's own alternatives
  bool shared = false;       ///< the rival has this form of the truth as well: no experiment can tell them
};

/// Which effects compete.
enum class Rivals { alternatives, catalogue };

/// Expected gaps of all truths of all sets, in each of their forms, against every rival that the experiment
/// could show.
///
///     gap = min over rival's forms, shapes, strengths and the nominal model's parameters of |L (y - y_r)|^2
///           + price of the rival - price of the truth,   y the noise-free outputs with the truth at work
///
/// L whitens by the noise that the recording had (white parts by the length of a row, the thermometer's by
/// f'(T) of the new run); prices are the diagnosis's own; the truth is two standard errors weaker than
/// fitted.
std::vector<ExpectedGap> expected_gaps(const Experiment& experiment, const Stand& stand,
                                       const NominalModel& model, const TelemetryDiagnosis& diagnosis,
                                       const std::vector<AlternativeSet>& sets,
                                       Rivals rivals = Rivals::catalogue);

/// Gaps by pair of effects, each the smallest of its forms that are not shared (of all, where all are) and,
/// between alternatives, of the two ways round.
std::vector<ExpectedGap> by_pair(const std::vector<ExpectedGap>& gaps);

}  // namespace hemi::diagnosis

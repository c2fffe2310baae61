// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "golden/diagnosis/block_statistics.hpp"
#include "golden/diagnosis/hypothesis.hpp"

namespace hemi::diagnosis {

/// Squares before and after, on the rows of the fit and on blocks that it has not seen.
struct Improvement {
  Output output = Output::rate;
  Gain train, held_out;
  Gain held_out_white;     ///< residuals whitened by the noise of the fit: what significance is judged by
  double floor_rms = 0.0;  ///< noise that is expected of rows of this length
};

/// What a set of effects gains on stretches that its fit has not seen.
struct HeldOut {
  std::vector<Improvement> improvements;  ///< one for every output that a member acts on
  std::vector<Gain> alone;  ///< of several members each beside all others, as Improvement::held_out_white
};

/// Free runs of the baseline and of a set of effects from the inputs alone, parameters of both without every
/// eighth of forty contiguous stretches in turn, shapes moved along with the coefficients (one Gauss-Newton
/// step). `baseline` has the noise of `fit`; a member alone is judged by its entry of `judged`.
HeldOut held_out(Hypotheses& hypotheses, const std::vector<Member>& members, const HypothesisFit& fit,
                 const HypothesisFit& baseline, const std::vector<Output>& judged);

/// Disagreement between the two halves of a recording over a member's trace, in standard deviations, a tenth
/// of the trace at least; nothing where a half cannot tell it.
std::optional<double> halves_disagree(Hypotheses& hypotheses, const std::vector<Member>& members,
                                      std::size_t which, const HypothesisFit& fit);

}  // namespace hemi::diagnosis

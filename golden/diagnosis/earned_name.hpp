// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

/// Free runs of the baseline and of a set of effects from the inputs alone, parameters of both without every
/// eighth of forty contiguous stretches in turn, shapes moved along with the coefficients (one Gauss-Newton
/// step). One entry for every output that a member acts on.
std::vector<Improvement> improvements(Hypotheses& hypotheses, const std::vector<Member>& members,
                                      const HypothesisFit& fit);

/// What each of several members gains on stretches left out beside all others: whitened residuals of the rows
/// of its entry of `outputs`, as Improvement::held_out_white.
std::vector<Gain> gains_left_out(Hypotheses& hypotheses, const std::vector<Member>& members,
                                 const HypothesisFit& fit, const std::vector<Output>& outputs);

/// A figure with its 95 % interval.
struct Interval {
  Figure figure;
  double low = 0.0, high = 0.0;
  double held_by_start = 0.0;  ///< of `high`: what the start temperature may hold of the figure
};

/// Figures of each member; covariance of coefficients and log shapes together, by the delta method, beside
/// what the forms may be wrong by (form_directions).
std::vector<std::vector<Interval>> intervals(Hypotheses& hypotheses, const std::vector<Member>& members,
                                             const HypothesisFit& fit);

/// Disagreement between the two halves of a recording over a member's trace, in standard deviations, a tenth
/// of the trace at least; nothing where a half cannot tell it.
std::optional<double> halves_disagree(Hypotheses& hypotheses, const std::vector<Member>& members,
                                      std::size_t which, const HypothesisFit& fit);

/// What a recording can show: the smallest detectable size of an effect, five standard errors over its noise.
struct DetectionLimit {
  std::string effect, form;
  std::vector<Figure> smallest;
};

/// Two effects that this recording cannot tell apart by more than a tenth of what either leaves.
struct Inseparable {
  std::string one, other;
  double overlap = 0.0;  ///< cosine of their traces, what the baseline explains taken off
};

struct Isolability {
  std::vector<DetectionLimit> limits;
  std::vector<Inseparable> pairs;
};
Isolability isolability(Hypotheses& hypotheses, const Noise& noise);

struct Decoys {
  std::size_t made = 0, accepted = 0;
};
/// Copies of every form's trace, moved around a circle by a random share of the recording, against the price
/// that a name is asked for.
Decoys decoys(Hypotheses& hypotheses, const std::vector<Member>& members, const HypothesisFit& fit,
              std::uint64_t seed);

}  // namespace hemi::diagnosis

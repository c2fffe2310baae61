// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "golden/diagnosis/hypothesis.hpp"

namespace hemi::diagnosis {

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

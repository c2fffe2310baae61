// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "golden/diagnosis/hypothesis.hpp"

namespace hemi::diagnosis {

/// By what the members of a fit may differ from the forms that they were given: every other form and shape of
/// the same effect, matched to the member's trace by least squares beside the baseline, less that trace, each
/// with a prior of 1 / sqrt(number of forms). Returned are the directions of these differences that stand
/// above the noise by more than one deviation, as columns with a prior of one deviation; none for weak
/// effects and for effects of a single form. A physical effect does not know our equation of it: what is
/// named beside a strong effect, and how well the strong one's numbers are known, must not rest on its form
/// being exact. `which`: members that are considered; `farthest`: forms whose difference is
/// larger than this share of the trace are none that could be meant.
Reduced form_directions(Hypotheses& hypotheses, const std::vector<Member>& members, const HypothesisFit& fit,
                        const std::vector<std::size_t>& which,
                        double farthest = std::numeric_limits<double>::infinity());

/// What a member gains beside all other members and by what these may differ from their forms.
double gain_beside_forms(Hypotheses& hypotheses, const std::vector<Member>& members, const HypothesisFit& fit,
                         std::size_t which);

}  // namespace hemi::diagnosis

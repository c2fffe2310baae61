// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/diagnosis/hypothesis.hpp"

namespace hemi::diagnosis {

/// Colour of an output's noise beyond what the model states.
struct Colour {
  Output output = Output::rate;
  double evidence = 0.0;           ///< gain in -2 log restricted likelihood over the stated colour
  double walk = 0.0;               ///< random walk per root second, unit of the output
  double flicker = 0.0;            ///< standard deviation of the 1/f part over the recording
  double flicker_rthz = 0.0;       ///< the same as one-sided amplitude density at 1 Hz
  double log_deviation = 0.0;      ///< of the better one's logarithm
  double walk_over_flicker = 0.0;  ///< difference of their -2 log likelihoods, positive: walk is better
  /// What a single slow sinusoid beside the colour gains [-2 log likelihood], less its price: noise has none.
  double line_gain = 0.0;
  bool is_line() const { return line_gain > 40.0; }
};
/// `beside`: columns that the noise is not to explain either (form_directions).
Colour colour_of(Hypotheses& hypotheses, const std::vector<Member>& members, const Reduced& beside,
                 Output output);

}  // namespace hemi::diagnosis

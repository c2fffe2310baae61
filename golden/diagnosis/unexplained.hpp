// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "golden/diagnosis/hypothesis.hpp"

namespace hemi::diagnosis {

/// What a set of effects leaves in one output, and whether some input of the recording carries it.
struct Remainder {
  Output output = Output::rate;
  std::string variable;        ///< channel of the recording that orders it best; empty: none does
  double evidence = 0.0;       ///< gain in -2 log likelihood of a free function of it, less its price (BIC)
  Eigen::VectorXd at, value;   ///< that function: nodes and values, unit of the output
  Eigen::VectorXd half_width;  ///< 95 %
  Eigen::VectorXd fitted;      ///< that function along the reduced rows of the output
  double share = 0.0;          ///< of the squares that the baseline left beyond noise, still there
};

/// Tries free functions (linear splines, 8 to 64 nodes) of every input for every output, beside a set of
/// effects, noise estimated again for each. One entry for every output where the best one's evidence is above
/// `threshold`.
std::vector<Remainder> remainders(Hypotheses& hypotheses, const std::vector<Member>& members,
                                  double threshold);

/// That free function at every row of the telemetry.
Eigen::VectorXd along_rows(const Simulation& simulation, const Remainder& remainder);

/// Colour of an output's noise beyond what the model states.
struct Colour {
  Output output = Output::rate;
  double evidence = 0.0;           ///< gain in -2 log restricted likelihood over the stated colour
  double walk = 0.0;               ///< random walk per root second, unit of the output
  double flicker = 0.0;            ///< standard deviation of the 1/f part over the recording
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

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

/// Tries free functions (linear splines, 8 to 64 nodes; 128 over the resonator's temperature) of every input
/// for every output, beside a set of effects, noise estimated again for each. For every output the best one
/// of an input, then the best one of time, where their evidence is above `threshold`.
std::vector<Remainder> remainders(Hypotheses& hypotheses, const std::vector<Member>& members,
                                  double threshold);

/// That free function at every row of the telemetry.
Eigen::VectorXd along_rows(const Simulation& simulation, const Remainder& remainder);

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
// Round numbers along an axis.
#ifndef HEMI_CLI_REPORT_TICKS_HPP
#define HEMI_CLI_REPORT_TICKS_HPP

#include <string>
#include <vector>

namespace hemi::report {

struct Tick {
  double value;
  std::string label;  ///< empty: a line without a number
};

/// Multiples of 1, 2 or 5 times a power of ten from low to high, about `wanted` of them. low < high, finite.
std::vector<Tick> linear_ticks(double low, double high, int wanted);

/// Powers of ten from low to high, with their multiples between them; over less than two decades the
/// multiples by 2 and 5 are labelled too. 0 < low < high.
std::vector<Tick> log_ticks(double low, double high);

/// A number as people write it: digits where they suffice, else m x 10^n with superscripts.
std::string nice_number(double value, int significant = 6);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_TICKS_HPP

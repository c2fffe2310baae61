// SPDX-License-Identifier: Apache-2.0
// Statistics of the score.
#ifndef HEMI_CLI_PROVE_FIGURES_HPP
#define HEMI_CLI_PROVE_FIGURES_HPP

#include <utility>
#include <vector>

#include "cli/prove/answer.hpp"

namespace hemi::prove {

/// `hits` of `trials`.
struct Rate {
  int hits = 0, trials = 0;
  void add(bool hit) {
    hits += hit ? 1 : 0;
    ++trials;
  }
  double value() const { return trials > 0 ? static_cast<double>(hits) / trials : 0.0; }
};

/// Wilson's 95 % interval of a binomial rate; [0, 1] without trials.
std::pair<double, double> wilson95(const Rate& rate);

/// 0 for an empty vector; mean of the middle two for an even count.
double median(std::vector<double> values);

/// 95 % interval of the median from order statistics (binomial), the extremes where there are too few.
std::pair<double, double> median_interval95(std::vector<double> values);

/// Mean and its 95 % interval, normal approximation.
struct Mean {
  double value = 0.0, low = 0.0, high = 0.0;
};
Mean mean95(const std::vector<double>& values);

/// Expected calibration error over ten equal bins of probability: sum of bin weight times |mean stated
/// probability - share that was right|.
double calibration_error(const std::vector<std::pair<double, bool>>& stated);

/// Length of the intersection over length of the union; 0 where both are empty.
double overlap(const Stretches& a, const Stretches& b);

}  // namespace hemi::prove

#endif  // HEMI_CLI_PROVE_FIGURES_HPP

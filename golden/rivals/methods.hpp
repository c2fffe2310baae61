// SPDX-License-Identifier: Apache-2.0
// Four common ways to find what a model leaves out, each with the stopping rule that is usual for it.
#pragma once

#include <string>
#include <vector>

#include "golden/rivals/library.hpp"

namespace hemi::rivals {

/// Names, the strongest first; none: nothing found.
using Names = std::vector<std::string>;

/// Stepwise regression of the paper (Eq. 21-22): the candidate with the smallest p of its partial F enters
/// while p < 0.01 and BIC falls; members leave when their p rises above 0.05. White noise assumed.
Names stepwise(const std::vector<Problem>& problems);

/// Sequentially thresholded least squares (SINDy) over base and candidates, columns scaled to unit deviation;
/// the threshold from a grid of 24 by AIC.
Names sparse(const std::vector<Problem>& problems);

/// Gaussian-process discrepancy a channel: squared-exponential kernel with one length a input,
/// hyperparameters by marginal likelihood on `points` rows; a channel is named after its most relevant input
/// where the likelihood beats noise alone by ln n for each length and the signal variance.
Names gaussian_process(const std::vector<Problem>& problems, int points = 200);

/// Higher powers of temperature in each channel, by F-test at 1 %.
Names polynomial(const std::vector<Problem>& problems);

}  // namespace hemi::rivals

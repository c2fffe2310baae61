// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "golden/calibration/rows.hpp"

namespace hemi::calibration {

/// Parts of a one-sided power spectral density S(f) = white^2 + flicker^2 / f + random_walk^2 / f^2 +
/// differenced^2 f^2, each as amplitude density at 1 Hz [unit / sqrt(Hz)].
struct NoiseParts {
  double white = 0.0;
  double flicker = 0.0;
  double random_walk = 0.0;
  double differenced = 0.0;
  double to_tau_s = 0.0;  ///< longest averaging time that was looked at
};

/// Allan variance of the four parts, each of unit density, at the averaging time tau of samples every
/// interval: 1 / (2 tau), 2 ln 2, (2 pi)^2 tau / 6, 3 / (8 pi^2 interval tau^2). Source: NIST SP 1065,
/// section 6.7, with the bandwidth of averaged samples, half their rate, for the last.
std::array<double, 4> allan_of_parts(double tau_s, double interval_s);

/// Densities whose Allan variances add up to the measured ones: least squares of relative residuals, weighted
/// by the equivalent degrees of freedom, over all sets of parts; a part enters where it lowers the weighted
/// sum by more than twelve (the points are correlated, so Akaike's two would let in too many). residual: a
/// channel less its model, equally spaced inside the segments; averaging times run in octaves to an eighth of
/// the longest segment and at most `longest_tau_s`. Segments shorter than 64 rows are not used. Throws
/// std::invalid_argument where no segment is that long.
NoiseParts fit_noise_parts(const Eigen::VectorXd& residual, const std::vector<RowRange>& segments,
                           double interval_s, double longest_tau_s);

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hemi::diagnosis {

/// Gaussian noise of one output's rows: white, and first-order processes x' = a x + u that are independent of
/// each other. 1/f noise is a sum of such with equal variances and correlation times in geometric order
/// (within 3 % for a ratio of 6); a random walk one whose time is far longer than the recording. A block's
/// mean of a walk with steps of variance s a block is its value at the block's start and a part of variance s
/// / 3 whose covariance with the step is s / 2 (integrals of a Wiener process over the block).
struct ColouredNoise {
  double white = 1.0;           ///< variance of a row
  Eigen::VectorXd variance;     ///< of each process
  Eigen::VectorXd correlation;  ///< a of each, from block to block, inside (0, 1)
  double walk_step = 0.0;       ///< s of the walk, which is the last of the processes; 0: there is none

  double total_variance() const { return white + variance.sum() + walk_step / 3.0; }
};

/// Variance of each process over h^2 of a one-sided density h^2 / f: ln 6 between processes a factor 6 apart.
inline constexpr double kFlickerPerProcess = 1.791759469228055;

/// Kinds of colour that an output's noise may have, in units of blocks.
Eigen::VectorXd flicker_correlations(Eigen::Index blocks);
double walk_correlation(Eigen::Index blocks);

/// White part, level of a 1/f part (variance per process) and variance per block of a walk, put together;
/// `behind` and `behind_correlation`: a process of its own (thermometer noise behind a time constant).
struct NoiseShape {
  double white = 1.0, flicker = 0.0, walk = 0.0, behind = 0.0, behind_correlation = 0.0;
};
ColouredNoise coloured_noise(const NoiseShape& shape, Eigen::Index blocks);

/// Innovations of a Kalman filter over rows at the given block numbers (ascending; numbers left out are
/// blocks without a value), divided by their standard deviations: noise of this kind comes out white with
/// variance 1. `log_determinant`: of the rows' covariance.
Eigen::MatrixXd whiten(const Eigen::MatrixXd& rows, const std::vector<Eigen::Index>& blocks,
                       const ColouredNoise& noise, double* log_determinant = nullptr);

/// Fits the shape to y = X b + e by restricted maximum likelihood, X with orthonormal columns. 1/f part and
/// walk are no smaller against the white part than expected: what a maker states of his noise is knowledge.
/// More of a part is kept if it gains more than log(rows); behind_correlation is as expected. Source: as
/// calibration::fit_noise; Kalman filter for the likelihood: Harvey, Forecasting, Structural Time Series
/// Models and the Kalman Filter (1989), section 3.4.
NoiseShape fit_noise_shape(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                           const std::vector<Eigen::Index>& blocks, const NoiseShape& expected);

/// -2 log restricted likelihood of a shape, its scale free (out: the best).
double restricted_likelihood(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                             const std::vector<Eigen::Index>& blocks, const NoiseShape& shape, double* scale);

}  // namespace hemi::diagnosis

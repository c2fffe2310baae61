// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hemi::diagnosis {

/// First-order lag of the recording format: y[0] = start, y[i] = y[i-1] + (1 - exp(-step / tau)) (x[i] -
/// y[i-1]); tau <= 0: x itself.
Eigen::ArrayXd lag(const Eigen::ArrayXd& x, double step_s, double tau_s, double start);

/// Largest less smallest value; zero of nothing.
double span(const Eigen::ArrayXd& x);

/// Central differences over the step, one-sided at the ends.
Eigen::ArrayXd slope_in_time(const Eigen::ArrayXd& x, double step_s);

/// Local cubics by least squares over +-half_width_s (Savitzky and Golay, Analytical Chemistry 36 (1964)
/// 1627), the outermost windows' cubics at the ends: takes a thermometer's steps off what moves slowly.
Eigen::ArrayXd smoothed(const Eigen::ArrayXd& x, double step_s, double half_width_s);

/// Median of 2 half + 1 rows, fewer at the ends: takes off noise, leaves steps where they are.
Eigen::ArrayXd running_median(const Eigen::ArrayXd& x, Eigen::Index half);

/// The series `rows` rows ago, straight lines between rows; its first value before it begins.
Eigen::ArrayXd late(const Eigen::ArrayXd& x, double rows);

/// The middle value, of an even number the upper of the two; zero of nothing.
double median(std::vector<double> values);
double median(const Eigen::VectorXd& values);

/// Root mean square of one value at least.
double rms(const Eigen::VectorXd& values);

/// Standard deviation of Gaussian noise from the median of |x|.
double robust_deviation(std::vector<double> values);

}  // namespace hemi::diagnosis

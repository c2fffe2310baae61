// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace hemi::diagnosis {

struct Projection {
  Eigen::VectorXd coefficients;
  Eigen::VectorXd left_out;  ///< y as predicted from all blocks but a row's own
};

/// y as a sum of columns, ridge regression. The first column is a constant and is not shrunk; the others are
/// of size one, so that a ridge of one size means the same for all. Its size: the one of 1e-12 .. 100 with
/// the least squares over four contiguous blocks left out in turn. Source: Hoerl and Kennard, Technometrics
/// 12 (1970) 55.
Projection project(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y);

/// Ascending coefficients in t of sum_k c_k (scale t + offset)^k.
Eigen::VectorXd substituted(const Eigen::VectorXd& c, double scale, double offset);

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/ridge_projection.hpp"

#include <Eigen/Cholesky>
#include <limits>

namespace hemi::diagnosis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kProjectionBlocks = 4;

VectorXd ridge_solution(const MatrixXd& normal, const VectorXd& right, double shrink) {
  MatrixXd heavier = normal;
  heavier.diagonal().tail(normal.cols() - 1).array() += shrink;
  return heavier.ldlt().solve(right);
}

}  // namespace

Projection project(const MatrixXd& x, const VectorXd& y) {
  const Index n = x.rows();
  const MatrixXd normal = x.transpose() * x;
  const VectorXd right = x.transpose() * y;
  Projection best;
  double least = std::numeric_limits<double>::infinity();
  for (double share = 1e-12; share < 1e3; share *= 10.0) {
    const double shrink = share * static_cast<double>(n);
    VectorXd left_out(n);
    for (Index b = 0; b < kProjectionBlocks; ++b) {
      const Index from = n * b / kProjectionBlocks, length = n * (b + 1) / kProjectionBlocks - from;
      const auto block = x.middleRows(from, length);
      left_out.segment(from, length) =
          block * ridge_solution(normal - block.transpose() * block,
                                 right - block.transpose() * y.segment(from, length), shrink);
    }
    const double squares = (y - left_out).squaredNorm();
    if (squares >= least) continue;
    least = squares;
    best = {ridge_solution(normal, right, shrink), left_out};
  }
  return best;
}

VectorXd substituted(const VectorXd& c, double scale, double offset) {
  VectorXd sum = VectorXd::Zero(c.size());
  for (Index k = c.size() - 1; k >= 0; --k) {
    VectorXd next = offset * sum;
    next.tail(c.size() - 1) += scale * sum.head(c.size() - 1);
    next[0] += c[k];
    sum = next;
  }
  return sum;
}

}  // namespace hemi::diagnosis

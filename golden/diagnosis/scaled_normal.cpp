// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/scaled_normal.hpp"

#include <utility>

namespace hemi::diagnosis {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Zero for a column of zeros: a prior on it must not overflow.
VectorXd inverse(const VectorXd& size) {
  return (size.array() > 0.0).select(size.cwiseInverse(), 0.0);
}

}  // namespace

ScaledNormal::ScaledNormal(VectorXd scale, const MatrixXd& products, const VectorXd& prior, double ridge)
    : scale_(std::move(scale)) {
  MatrixXd normal = scale_.asDiagonal() * products * scale_.asDiagonal();
  normal.diagonal() += scale_.cwiseAbs2().cwiseProduct(prior);
  normal.diagonal().array() += ridge;
  normal_.compute(normal);
}

ScaledNormal::ScaledNormal(const MatrixXd& columns, const VectorXd& prior, double ridge)
    : ScaledNormal(inverse(columns.colwise().norm()), columns.transpose() * columns, prior, ridge) {}

ScaledNormal ScaledNormal::of_products(const MatrixXd& products, double ridge) {
  return {inverse(products.diagonal().cwiseMax(0.0).cwiseSqrt()), products, VectorXd::Zero(products.rows()),
          ridge};
}

MatrixXd ScaledNormal::solve(const MatrixXd& right) const {
  return scale_.asDiagonal() * normal_.solve(scale_.asDiagonal() * right);
}

MatrixXd ScaledNormal::covariance() const {
  return scale_.asDiagonal() * normal_.solve(MatrixXd::Identity(scale_.size(), scale_.size())) *
         scale_.asDiagonal();
}

}  // namespace hemi::diagnosis

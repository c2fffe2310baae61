// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/scaled_normal.hpp"

#include <utility>

namespace hemi::diagnosis {

using Eigen::MatrixXd;
using Eigen::VectorXd;

ScaledNormal::ScaledNormal(VectorXd scale, const MatrixXd& products, const VectorXd& prior, double ridge)
    : scale_(std::move(scale)) {
  MatrixXd normal = scale_.asDiagonal() * products * scale_.asDiagonal();
  normal.diagonal() += scale_.cwiseAbs2().cwiseProduct(prior);
  normal.diagonal().array() += ridge;
  normal_.compute(normal);
}

ScaledNormal::ScaledNormal(const MatrixXd& columns, const VectorXd& prior, double ridge)
    : ScaledNormal(columns.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse(),
                   columns.transpose() * columns, prior, ridge) {}

ScaledNormal ScaledNormal::of_products(const MatrixXd& products, double ridge) {
  return {products.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse(), products,
          VectorXd::Zero(products.rows()), ridge};
}

MatrixXd ScaledNormal::solve(const MatrixXd& right) const {
  return scale_.asDiagonal() * normal_.solve(scale_.asDiagonal() * right);
}

MatrixXd ScaledNormal::covariance() const {
  return scale_.asDiagonal() * normal_.solve(MatrixXd::Identity(scale_.size(), scale_.size())) *
         scale_.asDiagonal();
}

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "golden/chain/arithmetic.hpp"

namespace hemi::golden {

/// The channels of the demodulated pickoffs, the columns of every matrix of them.
enum Channel { channel_xi, channel_xq, channel_yi, channel_yq, channels };

/// xi = x cos, xq = -(x sin), likewise y, each product rounded to config::product before the sign is changed.
/// x, y: fractions of full scale in [-1, 1); rows of the result: samples.
inline void demodulate(
    const Arithmetic& arithmetic, const Eigen::Ref<const Eigen::ArrayXd>& x,
    const Eigen::Ref<const Eigen::ArrayXd>& y, const Eigen::Ref<const Eigen::ArrayXd>& cosine,
    const Eigen::Ref<const Eigen::ArrayXd>& sine,
    Eigen::Ref<Eigen::Array<double, Eigen::Dynamic, channels>, 0, Eigen::OuterStride<>> products) {
  const auto round = [&arithmetic](double v) { return arithmetic.round(v, config::product.fraction); };
  products.col(channel_xi) = (x * cosine).unaryExpr(round);
  products.col(channel_xq) = 0.0 - (x * sine).unaryExpr(round);
  products.col(channel_yi) = (y * cosine).unaryExpr(round);
  products.col(channel_yq) = 0.0 - (y * sine).unaryExpr(round);
}

}  // namespace hemi::golden

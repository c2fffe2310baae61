// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "golden/chain/demodulator.hpp"

namespace hemi::golden {

/// Impulse response of ((1 - z^-R) / (1 - z^-1))^5: 5 (R - 1) + 1 whole numbers with sum R^5.
inline Eigen::VectorXd cic_coefficients(int decimation) {
  Eigen::VectorXd response = Eigen::VectorXd::Ones(1);
  for (int stage = 0; stage < config::cic_order; ++stage) {
    Eigen::VectorXd wider = Eigen::VectorXd::Zero(response.size() + decimation - 1);
    for (int delay = 0; delay < decimation; ++delay) wider.segment(delay, response.size()) += response;
    response = wider;
  }
  return response;
}

/// Decimator of all channels: at each tick the convolution of the last 5 (R - 1) + 1 products with
/// cic_coefficients, over 2^g (g = growth bits), rounded to config::baseband. Gain at zero frequency R^5 /
/// 2^g.
///
/// Exact in doubles: products are whole multiples of 2^-23 below 1 in magnitude (at most 2^23 steps),
/// coefficients are positive whole numbers with sum R^5. Any sum of some of the terms, in whatever order, is
/// at most 2^23 R^5 steps: 2^44.6 for R = 20, 2^51.3 for R = 50, below 2^53. For the same reason the word of
/// 24 + g bits that integrators and combs work in modulo 2^(24 + g) never wraps in its final value.
class Cic {
 public:
  using Baseband = Eigen::Matrix<double, channels, 1>;
  using Products = Eigen::Array<double, Eigen::Dynamic, channels>;

  Cic(Precision precision, int decimation)
      : arithmetic_(precision),
        decimation_(decimation),
        gain_(power_of_two(-config::growth_bits(decimation, config::cic_order))),
        weights_(Eigen::VectorXd::Zero(Eigen::Index{config::cic_order} * decimation)),
        history_(Products::Zero(weights_.size(), channels)) {
    const Eigen::VectorXd coefficients = cic_coefficients(decimation);
    weights_.tail(coefficients.size()) = coefficients;  // symmetric: the order of time does not matter
  }

  /// Where the products of samples first, ..., first + count - 1 of the running tick are written.
  auto samples(Eigen::Index first, Eigen::Index count) {
    return history_.middleRows(history_.rows() - decimation_ + first, count);
  }

  /// Closes the tick.
  Baseband tick() {
    const Baseband sums = history_.matrix().transpose() * weights_;
    history_.topRows(history_.rows() - decimation_) =
        history_.bottomRows(history_.rows() - decimation_).eval();
    return (sums * gain_).unaryExpr([this](double v) {
      return arithmetic_.round(v, config::baseband.fraction);
    });
  }

 private:
  Arithmetic arithmetic_;
  Eigen::Index decimation_;
  double gain_;
  Eigen::VectorXd weights_;  // oldest sample first
  Products history_;         // oldest sample first; the last R rows are the running tick
};

/// Symmetric five-tap filter with a double zero at 1150.3 Hz of 5 kHz; gain 49/64, delay two ticks. Cannot
/// overflow: sum |tap| / 64 = 81/64 against an input of at most R^5 / 2^g = 0.763.
class ImageFilter {
 public:
  explicit ImageFilter(Precision precision) : arithmetic_(precision) {
    for (Eigen::Index i = 0; i < 5; ++i)
      taps_[i] = config::image_taps[i] * power_of_two(-config::image_shift);
  }

  Cic::Baseband tick(const Cic::Baseband& input) {
    history_.leftCols<4>() = history_.rightCols<4>().eval();
    history_.col(4) = input;
    return (history_ * taps_).unaryExpr([this](double v) {
      return arithmetic_.round(v, config::baseband.fraction);
    });
  }

 private:
  Arithmetic arithmetic_;
  Eigen::Matrix<double, 5, 1> taps_;
  Eigen::Matrix<double, channels, 5> history_ = Eigen::Matrix<double, channels, 5>::Zero();
};

}  // namespace hemi::golden

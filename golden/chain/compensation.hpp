// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "golden/chain/arithmetic.hpp"

namespace hemi::golden {

/// Register values in real units, indexed by config::RegisterIndex.
using RegisterValues = std::array<double, config::register_count>;

/// Temperature as a polynomial of order 5 in the frequency's offset from its reference, in units of 64 Hz.
class Thermometer {
 public:
  struct Output {
    double offset;         ///< 64 nominal Hz
    double temperature_c;  ///< degC
    bool out_of_range;
    bool clipped;
  };

  Thermometer(Precision precision, const RegisterValues& values) : arithmetic_(precision), values_(values) {}

  /// difference_hz: nominal Hz from the reference.
  Output operator()(double difference_hz) const {
    Output out{0.0, 0.0, false, false};
    out.offset = arithmetic_.saturate(
        arithmetic_.round(difference_hz / config::offset_span_hz, config::offset.fraction), config::offset,
        out.out_of_range);
    out.temperature_c = values_[config::reg_thermometer_5];
    for (std::size_t i = config::reg_thermometer_5; i-- > config::reg_thermometer_0;) {
      const double product =
          arithmetic_.round_product(out.temperature_c, out.offset, config::temperature.fraction);
      out.temperature_c = arithmetic_.saturate(product + values_[i], config::temperature, out.clipped);
    }
    return out;
  }

 private:
  Arithmetic arithmetic_;
  RegisterValues values_;
};

/// df/dt: least-squares slope over 16 blocks of 2^log2_block outputs, as a fraction of a programmable full
/// scale.
///
/// Least squares on equally spaced block sums b weighs them by their distance from the middle, (2 j - 15) /
/// 2; the sum over j of (2 j - 15) b[j] is the `slope_sum`.
class Derivative {
 public:
  struct Output {
    double slope_sum;  ///< nominal Hz; of the last block
    double value;      ///< fraction of full scale
    bool invalid;
    bool clipped;
  };

  Derivative(Precision precision, const RegisterValues& values)
      : arithmetic_(precision),
        block_(std::exp2(values[config::reg_log2_block])),
        scale_(std::exp2(config::slope_sum.fraction - config::slope_word.fraction -
                         values[config::reg_slope_shift])),
        gain_(values[config::reg_slope_gain]) {}

  /// difference_hz: nominal Hz from the reference; good: valid frequency of a locked loop.
  Output operator()(double difference_hz, bool good) {
    bool clipped = false;
    if (good) {
      add(arithmetic_.saturate(arithmetic_.round(difference_hz, config::fine_offset.fraction),
                               config::fine_offset, clipped),
          clipped);
    } else {
      sum_ = count_ = value_ = 0.0;
      fill_ = 0;
    }
    return {slope_sum_, value_, fill_ < config::derivative_blocks, clipped};
  }

 private:
  using Blocks = Eigen::Array<double, config::derivative_blocks, 1>;

  void add(double difference_hz, bool& clipped) {
    sum_ = arithmetic_.wrap(sum_ + difference_hz, config::block_sum);
    count_ += 1.0;
    if (count_ != block_) return;
    blocks_.head<config::derivative_blocks - 1>() = blocks_.tail<config::derivative_blocks - 1>().eval();
    blocks_[config::derivative_blocks - 1] = sum_;
    sum_ = count_ = 0.0;
    fill_ = std::min(fill_ + 1, config::derivative_blocks);
    if (fill_ < config::derivative_blocks) return;
    const double last = config::derivative_blocks - 1;
    slope_sum_ = (Blocks::LinSpaced(-last, last) * blocks_).sum();
    const double word = arithmetic_.saturate(
        arithmetic_.round(slope_sum_ * scale_, config::slope_word.fraction), config::slope_word, clipped);
    value_ = arithmetic_.saturate(arithmetic_.round(word * gain_, config::derivative.fraction),
                                  config::derivative, clipped);
  }

  Arithmetic arithmetic_;
  double block_;
  double scale_;
  double gain_;
  Blocks blocks_ = Blocks::Zero();  // oldest first
  double sum_ = 0.0;
  double count_ = 0.0;
  double slope_sum_ = 0.0;
  double value_ = 0.0;
  int fill_ = 0;
};

/// The drift of the rate, all ten terms of Eq. (21) nested in offset o and derivative g, and the rate without
/// it: (rate - B) (1 + scale_correction).
class BiasModel {
 public:
  struct Output {
    double bias_dph;
    double compensated_dph;
    bool bias_clipped;
    bool compensation_clipped;
  };

  BiasModel(Precision precision, const RegisterValues& values) : arithmetic_(precision), values_(values) {}

  Output operator()(double o, double g, double rate_dph) const {
    using namespace config;
    Output out{0.0, 0.0, false, false};
    const auto step = [&](double factor, double variable, double addend) {
      return arithmetic_.saturate(arithmetic_.round_product(factor, variable, bias.fraction) + addend, bias,
                                  out.bias_clipped);
    };
    const auto& k = values_;
    const double in_f = step(step(k[reg_bias_f3], o, k[reg_bias_f2]), o, k[reg_bias_f]);
    const double of_g2 = step(k[reg_bias_f_df2], o, step(k[reg_bias_df3], g, k[reg_bias_df2]));
    const double of_g = step(step(k[reg_bias_f2_df], o, k[reg_bias_f_df]), o, k[reg_bias_df]);
    const double in_g = step(of_g2, g, of_g);
    out.bias_dph = step(in_f, o, step(in_g, g, k[reg_bias_0]));
    const double error = rate_dph - out.bias_dph;
    const double correction = arithmetic_.round(
        arithmetic_.floor(error, scale_operand.fraction) * k[reg_scale_correction], rate.fraction);
    out.compensated_dph = arithmetic_.saturate(error + correction, rate, out.compensation_clipped);
    return out;
  }

 private:
  Arithmetic arithmetic_;
  RegisterValues values_;
};

}  // namespace hemi::golden

// SPDX-License-Identifier: Apache-2.0
//
// derivative: df/dt by least squares over 16 blocks of M = 2^log2_block outputs.
//
//   slope_sum = sum_{j=0..15} (2j - 15) b_j, b_j block sums of f - f_reference;  slope = slope_sum 6/4080 /
//   (M^2 Ts)
//
// in       f - f_reference Q18.29, once an output
// out      derivative Q1.23 of a full scale that slope_shift and slope_gain set; moves once a block
// delay    (16 M - 1)/2 outputs, plus up to M - 1 while the value holds
// rounding f - f_reference half up to 2^-25 Hz and clipped; shift and gain half up and clipped (flag)
#ifndef HEMI_HLS_DERIVATIVE_HPP
#define HEMI_HLS_DERIVATIVE_HPP

#include "hls/thermometer.hpp"

namespace hemi {
namespace hls {

class DerivativeFilter {
 public:
  using BlockSum = Word<config::block_sum>;
  using SlopeSum = Word<config::slope_sum>;

  void reset() {
    for (int i = 0; i < config::derivative_blocks; ++i) block_[i] = BlockSum();
    slope_sum_ = SlopeSum();
    restart();
  }

  /// `good`: the frequency may be used; otherwise the window starts anew.
  Derivative step(const Thermometer::Difference& difference, bool good, const Registers& r, bool& saturated) {
    if (!good) {
      restart();
      return derivative_;
    }
    sum_ =
        wrap_add(sum_, clip<Word<config::fine_offset>, Clipped<config::fine_offset>>(difference, saturated));
    ++count_;
    if (count_ >= (std::int32_t{1} << r.log2_block)) close_block(r, saturated);
    return derivative_;
  }

  SlopeSum slope_sum() const { return slope_sum_; }
  bool valid() const { return fill_ == config::derivative_blocks; }

 private:
  void restart() {
    sum_ = BlockSum();
    count_ = 0;
    fill_ = 0;
    derivative_ = Derivative();
  }

  void close_block(const Registers& r, bool& saturated) {
    for (int i = 0; i < config::derivative_blocks - 1; ++i) block_[i] = block_[i + 1];
    block_[config::derivative_blocks - 1] = sum_;
    sum_ = BlockSum();
    count_ = 0;
    if (fill_ < config::derivative_blocks) ++fill_;
    if (!valid()) return;
    slope_sum_ = SlopeSum();
    for (int j = 0; j < config::derivative_blocks / 2; ++j) {
      using Weight = Fixed<5, 5>;
      const Weight weight = from_raw<Weight>(config::derivative_blocks - 1 - 2 * j);
      const SlopeSum difference = quantise<SlopeSum>(block_[config::derivative_blocks - 1 - j] - block_[j]);
      slope_sum_ = wrap_add(slope_sum_, quantise<SlopeSum>(difference * weight));
    }
    derivative_ = clip<Derivative, Clipped<config::derivative>>(
        shifted(r.slope_shift, saturated) * r.slope_gain, saturated);
  }

  /// slope_sum / 2^shift, rounded half up and clipped, as a fraction.
  Word<config::slope_word> shifted(int shift, bool& saturated) const {
    const std::int64_t half = shift > 0 ? std::int64_t{1} << (shift - 1) : 0;
    const std::int64_t word = (raw(slope_sum_) + half) >> shift;
    constexpr std::int64_t limit = std::int64_t{1} << (config::slope_word.width - 1);
    saturated = saturated || word < -limit || word >= limit;
    return from_raw<Word<config::slope_word>>(word < -limit ? -limit : (word >= limit ? limit - 1 : word));
  }

  BlockSum block_[config::derivative_blocks];
  BlockSum sum_;
  SlopeSum slope_sum_;
  Derivative derivative_;
  std::int32_t count_ = 0;
  std::int32_t fill_ = 0;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_DERIVATIVE_HPP

// SPDX-License-Identifier: Apache-2.0
//
// rate_filter: the rate of each tick to the output rate, with the same triangular weights as the frequency.
//
//   rate = sum over 49 ticks of w_j gain source_j, w = 1..25..1;  H(f) = (sin(25 pi f/fl) / (25 sin(pi
//   f/fl)))^2
//
// in       secondary in phase Q1.27 (open loop) or rebalance command Q2.30; gain Q11.13 in deg/h / 625
// out      rate Q20.16 deg/h; -3 dB at 64 Hz, zeros at multiples of 200 Hz
// delay    24 ticks
// rounding tick half up to 2^-26 and clipped (flag); accumulators wrap, the combs undo it; output half up and
// clipped (flag)
#ifndef HEMI_HLS_RATE_FILTER_HPP
#define HEMI_HLS_RATE_FILTER_HPP

#include "hls/registers.hpp"

namespace hemi {
namespace hls {

class RateFilter {
 public:
  void reset() {
    first_ = second_ = RateAccumulator();
    comb_first_ = comb_second_ = RateAccumulator();
  }

  /// source: what measures the rate, the secondary in phase (open loop) or the rebalance command.
  template <class Source>
  RateTick step(const Source& source, const RegisterWord<config::reg_rate_gain>& gain, bool& saturated) {
    const RateTick tick = clip<RateTick, Clipped<config::rate_tick>>(source * gain, saturated);
    first_ = wrap_add(first_, tick);
    second_ = wrap_add(second_, first_);
    return tick;
  }

  Rate rate(bool& saturated) {
    const RateAccumulator once = wrap_sub(second_, comb_first_);
    comb_first_ = second_;
    const RateAccumulator twice = wrap_sub(once, comb_second_);
    comb_second_ = once;
    return clip<Rate, Clipped<config::rate>>(twice, saturated);
  }

 private:
  RateAccumulator first_, second_, comb_first_, comb_second_;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_RATE_FILTER_HPP

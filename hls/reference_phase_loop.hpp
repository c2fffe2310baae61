// SPDX-License-Identifier: Apache-2.0
//
// reference_phase_loop: steers the nco onto the primary; lock detector, hold-over, re-acquisition.
//
//   increment = integral + kp e,  integral += ki e  (and += kf (e - e_last) while unlocked and far off), e =
//   phase error in turns
//
// in       phase error Q0.32 turns, amplitude Q2.32; gains Q-6.30 (kp, kf), Q-16.40 (ki)
// out      increment Q1.48 turns a sample, in force one tick later
// latency  one tick
// rounding products half up to 2^-48; integral and increment clip (flag)
// lock     lock_count ticks with |e| < 1/16 turn, each tick outside costs 4; lost when the count is back at
// 0.
//          Below the amplitude threshold nothing moves (hold-over).
// source   F. M. Gardner, Phaselock Techniques, 3rd ed., ch. 2 (type 2 loop); kf: e - e_last is the frequency
// error without ambiguity
#ifndef HEMI_HLS_REFERENCE_PHASE_LOOP_HPP
#define HEMI_HLS_REFERENCE_PHASE_LOOP_HPP

#include "hls/phase_detector.hpp"
#include "hls/registers.hpp"

namespace hemi {
namespace hls {

class ReferencePhaseLoop {
 public:
  void reset(const Increment& start) {
    restart(start);
    last_ = Angle();
    holdover_ = false;
  }

  /// Forgets the lock and starts again from an increment.
  void restart(const Increment& start) {
    integral_ = start;
    increment_ = start;
    counter_ = 0;
    locked_ = false;
  }

  void step(const Polar& polar, const Registers& r, bool& saturated) {
    const Angle& e = polar.phase_error;
    const Angle change = wrap_sub(e, last_);
    last_ = e;
    const bool low = polar.amplitude < r.amplitude_threshold;
    if (low) {
      increment_ = integral_;
    } else {
      if (!locked_ && !inside<config::steering_window_log2>(raw(change))) {
        integral_ = add(integral_, correction(change * r.loop_frequency), saturated);
      }
      integral_ = add(integral_, correction(e * r.loop_integral), saturated);
      increment_ = add(integral_, correction(e * r.loop_proportional), saturated);
      count(raw(e), static_cast<std::int32_t>(raw(r.lock_count)));
    }
    if (counter_ >= raw(r.lock_count)) locked_ = true;
    if (counter_ == 0) locked_ = false;
    holdover_ = locked_ && low;
  }

  Increment increment() const { return increment_; }
  Increment integral() const { return integral_; }
  std::int32_t counter() const { return counter_; }
  bool locked() const { return locked_; }
  bool holdover() const { return holdover_; }

 private:
  template <class Expression>
  static Increment correction(const Expression& x) {
    return quantise<Increment>(quantise<Rounded<config::increment>>(x));
  }
  static Increment add(const Increment& a, const Increment& b, bool& saturated) {
    return clip<Increment, Clipped<config::increment>>(a + b, saturated);
  }
  /// -2^Log2 <= angle < 2^Log2, in units of 2^-32 turn.
  template <int Log2>
  static bool inside(std::int64_t angle) {
    return angle >= -(std::int64_t{1} << Log2) && angle < (std::int64_t{1} << Log2);
  }
  void count(std::int64_t error, std::int32_t limit) {
    if (inside<config::lock_window_log2>(error)) {
      counter_ = counter_ + 1 < limit ? counter_ + 1 : limit;
    } else {
      counter_ = counter_ > config::lock_penalty ? counter_ - config::lock_penalty : 0;
    }
  }

  Increment integral_, increment_;
  Angle last_;
  std::int32_t counter_ = 0;
  bool locked_ = false;
  bool holdover_ = false;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_REFERENCE_PHASE_LOOP_HPP

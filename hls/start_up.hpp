// SPDX-License-Identifier: Apache-2.0
//
// start_up: search, lock, amplitude rise, closing of quadrature and rebalance; hold-over and return to the
// search.
//
//   open (control = 0) | search -> acquire -> rise -> run, each tick at most one step (docs/chain.md has the
//   table)
//
// in       amplitude of this tick Q2.32, lock as the phase loop left it at the tick before
// out      state, and whether the phase loop starts again from `start` (Q1.48 turns a sample)
// latency  within the tick
#ifndef HEMI_HLS_START_UP_HPP
#define HEMI_HLS_START_UP_HPP

#include "hls/actuator_loop.hpp"

namespace hemi {
namespace hls {

class StartUp {
 public:
  void reset() {
    state_ = config::state_search;
    search_count_ = holdover_count_ = 0;
    offset_ = Increment();
    low_ = false;
  }

  /// True when the phase loop must start again, from start().
  bool step(const CordicWord& amplitude, bool locked, const Registers& r) {
    low_ = amplitude < r.amplitude_threshold;
    if (r.control == 0) {
      state_ = config::state_open;
      return false;
    }
    switch (state_) {
      case config::state_acquire:
        if (low_) {
          state_ = config::state_search;
        } else if (locked) {
          state_ = config::state_rise;
        }
        return false;
      case config::state_rise:
      case config::state_run:
        return follow(amplitude, locked, r);
      default:
        return search(amplitude, r);
    }
  }

  config::LoopState state() const { return state_; }
  Increment start(const Registers& r) const { return wrap_add(r.nco_start, offset_); }
  // The gain schedule. While the amplitude rises its integral would only wind up, and the quadrature loop,
  // whose gain goes with the amplitude, waits; the rebalance loop holds the pattern against rotation from the
  // lock on.
  LoopMode amplitude_mode() const { return mode(LoopMode::proportional); }
  LoopMode quadrature_mode() const { return mode(LoopMode::off); }
  LoopMode rebalance_mode() const { return mode(LoopMode::closed); }

 private:
  LoopMode mode(LoopMode in_rise) const {
    if (state_ < config::state_rise) return LoopMode::off;
    const LoopMode now = state_ == config::state_rise ? in_rise : LoopMode::closed;
    return low_ && now != LoopMode::off ? LoopMode::hold : now;
  }

  bool search(const CordicWord& amplitude, const Registers& r) {
    state_ = config::state_search;
    if (amplitude >= r.search_amplitude) {
      state_ = config::state_acquire;
      return false;
    }
    if (++search_count_ < r.search_ticks) return false;
    search_count_ = 0;
    offset_ = wrap_add(offset_, r.search_step);
    if (offset_ > r.search_span) offset_ = quantise<Increment>(-r.search_span);
    return true;
  }

  bool follow(const CordicWord& amplitude, bool locked, const Registers& r) {
    if (low_) {
      if (++holdover_count_ < r.holdover_ticks) return false;
      state_ = config::state_search;
      holdover_count_ = search_count_ = 0;
      offset_ = Increment();
      return true;
    }
    holdover_count_ = 0;
    if (!locked) {
      state_ = config::state_acquire;
    } else if (amplitude >= r.closing_amplitude) {
      state_ = config::state_run;
    }
    return false;
  }

  config::LoopState state_ = config::state_search;
  std::int32_t search_count_ = 0;
  std::int32_t holdover_count_ = 0;
  Increment offset_;
  bool low_ = false;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_START_UP_HPP

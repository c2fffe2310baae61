// SPDX-License-Identifier: Apache-2.0
//
// frequency_tracker: frequency from the total phase, nco plus detector.
//
//   P_k = (phase_{k-4} + phase_{k-5}) / 2 + phase_error_k,  mean of 25 P, differenced (Lambda weighting)
//
// in       nco phase after the tick Q5.48, phase error Q0.32, once a tick
// out      frequency Q17.29 in nominal Hz, once in 25 ticks; sum of 50 amplitudes and of 50 phase errors
// delay    centre of an output: 29 ticks less one sample before it is emitted
// rounding phase cut to 2^-32 turns; nothing is lost between outputs: their sum is the phase. Words wrap
// source   docs/chain.md; Lambda counters: S. Johansson, New frequency counting principle improves
// resolution, 2005
#ifndef HEMI_HLS_FREQUENCY_TRACKER_HPP
#define HEMI_HLS_FREQUENCY_TRACKER_HPP

#include "hls/phase_detector.hpp"

namespace hemi {
namespace hls {

class FrequencyTracker {
 public:
  void reset() {
    last_nco_ = Phase();
    for (int i = 0; i < delay; ++i) centre_[i] = TickPhase();
    tick_phase_ = TickPhase();
    total_ = sum_ = last_sum_ = TotalPhase();
    amplitude_ = last_amplitude_ = AmplitudeSum();
    error_ = last_error_ = PhaseErrorSum();
  }

  /// Tick: returns the phase of the signal on the detector's time.
  TickPhase step(const Phase& nco, const Polar& polar) {
    const Phase advance = wrap_sub(nco, last_nco_);
    last_nco_ = nco;
    const TickPhase newest = quantise<TickPhase>(wrap_sub(nco, shift_right(advance, 1)));
    const TickPhase phase = wrap_add(centre_[delay - 1], polar.phase_error);
    for (int i = delay - 1; i > 0; --i) centre_[i] = centre_[i - 1];
    centre_[0] = newest;
    total_ = wrap_add(total_, wrap_sub(phase, tick_phase_));
    tick_phase_ = phase;
    sum_ = wrap_add(sum_, total_);
    amplitude_ = wrap_add(amplitude_, polar.amplitude);
    error_ = wrap_add(error_, polar.phase_error);
    return phase;
  }

  /// Output: frequency in nominal Hz; one turn of the triangular sum is 8 Hz.
  Frequency frequency() {
    const TotalPhase difference = wrap_sub(sum_, last_sum_);
    last_sum_ = sum_;
    sum_ = TotalPhase();
    return quantise<Frequency>(scale<config::total_phase.fraction - config::frequency.fraction>(difference));
  }

  AmplitudeSum amplitude() { return over_two(amplitude_, last_amplitude_); }
  PhaseErrorSum phase_error() { return over_two(error_, last_error_); }

 private:
  static constexpr int delay = 4;

  Phase last_nco_;
  TickPhase centre_[delay];
  TickPhase tick_phase_;
  TotalPhase total_, sum_, last_sum_;
  AmplitudeSum amplitude_, last_amplitude_;
  PhaseErrorSum error_, last_error_;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_FREQUENCY_TRACKER_HPP

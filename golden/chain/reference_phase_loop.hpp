// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/chain/phase_detector.hpp"

namespace hemi::golden {

/// Proportional-integral loop that steers the nco, with frequency pull-in until it has locked and hold-over
/// while the amplitude is low. With gains Kp [turns/sample/turn] and Ki [the same, a tick] its linear model
/// is increment(z) = (Kp + Ki / (1 - z^-1)) phase_error(z), acting one tick later.
class ReferencePhaseLoop {
 public:
  struct Settings {
    double start;                ///< turns a sample
    double proportional;         ///< turns a sample a turn
    double integral;             ///< turns a sample a turn, each tick
    double frequency;            ///< turns a sample a turn
    double amplitude_threshold;  ///< of Polar::amplitude
    double lock_count;           ///< ticks
  };

  ReferencePhaseLoop(Precision precision, const Settings& settings)
      : arithmetic_(precision), settings_(settings), integral_(settings.start), increment_(settings.start) {}

  void tick(const Polar& detected);
  /// Unlocked at this increment, turns a sample; the tick that follows works on from it.
  void restart(double increment) {
    integral_ = increment_ = arithmetic_.wrap(increment, config::increment);
    counter_ = 0.0;
    locked_ = false;
  }

  double integral() const { return integral_; }    ///< turns a sample
  double increment() const { return increment_; }  ///< turns a sample, for the tick after next
  double lock_counter() const { return counter_; }
  bool locked() const { return locked_; }
  bool holdover() const { return locked_ && low_; }
  bool clipped() const { return clipped_; }  ///< in the last tick

 private:
  void steer(double phase_error, double difference);
  void judge(double phase_error);

  Arithmetic arithmetic_;
  Settings settings_;
  double integral_;
  double increment_;
  double last_error_ = 0.0;
  double counter_ = 0.0;
  bool locked_ = false;
  bool low_ = false;
  bool clipped_ = false;
};

}  // namespace hemi::golden

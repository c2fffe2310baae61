// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/chain/arithmetic.hpp"

namespace hemi::golden {

/// off: at rest, the integral waits at its start. hold: the command is the integral. proportional: closed,
/// but the integral does not move by the error. closed: proportional and integral.
enum class LoopMode { off, hold, proportional, closed };

/// Proportional-integral controller of one actuator with limits: command = Kp error + Ki sum of the errors,
/// both the sum and the command within [-limit, limit]. Once both together are beyond a limit, an error that
/// would lead further out is not integrated.
class ActuatorLoop {
 public:
  struct Settings {
    double proportional;  ///< fraction of the actuator's full scale
    double integral;      ///< the same, a tick
    double start;         ///< integral while off
    double limit;         ///< largest command, not negative
  };

  ActuatorLoop(Precision precision, const Settings& settings) : arithmetic_(precision), settings_(settings) {}

  void tick(LoopMode mode, double error);

  double integral() const { return integral_; }
  double command() const { return command_; }
  bool saturated() const { return saturated_; }  ///< in the last tick

 private:
  double within_limits(double value) const;
  void control(double error, double integral_gain);

  Arithmetic arithmetic_;
  Settings settings_;
  double integral_ = 0.0;
  double command_ = 0.0;
  bool saturated_ = false;
};

}  // namespace hemi::golden

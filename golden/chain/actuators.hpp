// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/chain/actuator_loop.hpp"
#include "golden/chain/compensation.hpp"
#include "golden/chain/modulator.hpp"
#include "golden/chain/phase_detector.hpp"

namespace hemi::golden {

/// The three loops behind the actuators: amplitude to its setpoint, secondary quadrature and secondary
/// in-phase to zero.
class Actuators {
 public:
  Actuators(Precision precision, const RegisterValues& values);

  /// state: of this tick; low: amplitude below its threshold, the loops that work hold their commands.
  void tick(config::LoopState state, bool low, double amplitude, const Secondary& secondary);

  const Commands& commands() const { return commands_; }
  const ActuatorLoop& amplitude_loop() const { return amplitude_; }
  const ActuatorLoop& quadrature_loop() const { return quadrature_; }
  const ActuatorLoop& rebalance_loop() const { return rebalance_; }

 private:
  double setpoint_;
  double search_drive_;
  ActuatorLoop amplitude_;
  ActuatorLoop quadrature_;
  ActuatorLoop rebalance_;
  Commands commands_;
};

}  // namespace hemi::golden

// SPDX-License-Identifier: Apache-2.0
#include "golden/chain/actuators.hpp"

namespace hemi::golden {

using namespace config;

namespace {

struct Modes {
  LoopMode amplitude = LoopMode::off;
  LoopMode quadrature = LoopMode::off;
  LoopMode rebalance = LoopMode::off;
};

Modes modes(LoopState state, bool low) {
  if (state == state_rise) {
    if (low) return {LoopMode::hold, LoopMode::off, LoopMode::hold};
    return {LoopMode::proportional, LoopMode::off, LoopMode::closed};
  }
  if (state == state_run) {
    if (low) return {LoopMode::hold, LoopMode::hold, LoopMode::hold};
    return {LoopMode::closed, LoopMode::closed, LoopMode::closed};
  }
  return {};
}

}  // namespace

Actuators::Actuators(Precision precision, const RegisterValues& r)
    : setpoint_(r[reg_amplitude_setpoint]),
      search_drive_(r[reg_drive_limit]),
      amplitude_(precision, {r[reg_amplitude_proportional], r[reg_amplitude_integral], r[reg_drive_start],
                             r[reg_drive_limit]}),
      quadrature_(precision, {r[reg_quadrature_proportional], r[reg_quadrature_integral],
                              r[reg_quadrature_start], r[reg_quadrature_limit]}),
      rebalance_(precision,
                 {r[reg_rebalance_proportional], r[reg_rebalance_integral], 0.0, r[reg_rebalance_limit]}) {}

void Actuators::tick(LoopState state, bool low, double amplitude, const Secondary& secondary) {
  const Modes mode = modes(state, low);
  amplitude_.tick(mode.amplitude, setpoint_ - amplitude);
  quadrature_.tick(mode.quadrature, secondary.quadrature);
  rebalance_.tick(mode.rebalance, 0.0 - secondary.in_phase);
  commands_ = {state == state_search ? search_drive_ : amplitude_.command(), quadrature_.command(),
               rebalance_.command()};
}

}  // namespace hemi::golden

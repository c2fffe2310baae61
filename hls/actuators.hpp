// SPDX-License-Identifier: Apache-2.0
//
// The actuator side: start_up and the three actuator loops at the loop rate, the modulator at each sample.
// What a tick computes is in force from the next tick on.
#ifndef HEMI_HLS_ACTUATORS_HPP
#define HEMI_HLS_ACTUATORS_HPP

#include "hls/modulator.hpp"
#include "hls/phase_detector.hpp"
#include "hls/start_up.hpp"
#include "hls/status.hpp"

namespace hemi {
namespace hls {

class Actuators {
 public:
  void reset() {
    start_up_.reset();
    drive_loop_.reset(Command());
    quadrature_loop_.reset(Command());
    rebalance_loop_.reset(Command());
    drive_dac_.reset();
    rebalance_dac_.reset();
    quadrature_dac_.reset();
    drive_ = rebalance_ = pending_drive_ = Command();
    offset_ = pending_offset_ = Angle();
    drive_word_ = rebalance_word_ = quadrature_word_ = DacWord();
    quadrature_in_force_ = pending_quadrature_word_ = DacWord();
    drive_sum_ = last_drive_sum_ = quadrature_sum_ = last_quadrature_sum_ = CommandSum();
  }

  /// At each sample: the DAC words that belong to it.
  template <class Probe>
  void sample(const Phase& phase, Probe& probe) {
    const Sine carrier = Nco::look_up(wrap_add(phase, offset_)).sine;
    drive_word_ = drive_dac_.step(-(drive_ * carrier));
    rebalance_word_ = rebalance_dac_.step(-(rebalance_ * carrier));
    quadrature_word_ = quadrature_in_force_;
    probe(config::tap_carrier, carrier);
    probe(config::tap_dac_drive, drive_word_);
    probe(config::tap_dac_rebalance, rebalance_word_);
  }

  /// First thing in a tick: what the tick before computed comes into force.
  void take_over() {
    drive_ = pending_drive_;
    rebalance_ = rebalance_loop_.command();
    offset_ = pending_offset_;
    quadrature_in_force_ = pending_quadrature_word_;
  }

  /// Behind the phase detector, before the phase loop: true when that must start again, from start().
  template <class Probe>
  bool start_up(const Polar& polar, bool locked, const Registers& r, Probe& probe) {
    const bool restart = start_up_.step(polar.amplitude, locked, r);
    probe(config::tap_state, from_raw<Fixed<4, 4>>(start_up_.state()));
    return restart;
  }
  Increment start(const Registers& r) const { return start_up_.start(r); }

  /// Behind the phase loop; `increment` is the one that it has just computed.
  template <class Probe>
  void loops(const Polar& polar, const Secondary& secondary, const Increment& increment, const Registers& r,
             Status& status, Probe& probe) {
    bool drive_saturated = false, quadrature_saturated = false, rebalance_saturated = false;
    const Baseband amplitude_error =
        quantise<Baseband>(quantise<Clipped<config::baseband>>(r.amplitude_setpoint - polar.amplitude));
    const Baseband rebalance_error =
        quantise<Baseband>(quantise<Clipped<config::baseband>>(-secondary.in_phase));
    drive_loop_.step(start_up_.amplitude_mode(), amplitude_error, r.amplitude_proportional,
                     r.amplitude_integral, r.drive_start, r.drive_limit, drive_saturated);
    quadrature_loop_.step(start_up_.quadrature_mode(), secondary.quadrature, r.quadrature_proportional,
                          r.quadrature_integral, r.quadrature_start, r.quadrature_limit,
                          quadrature_saturated);
    rebalance_loop_.step(start_up_.rebalance_mode(), rebalance_error, r.rebalance_proportional,
                         r.rebalance_integral, Command(), r.rebalance_limit, rebalance_saturated);
    pending_drive_ = start_up_.state() == config::state_search ? r.drive_limit : drive_loop_.command();
    pending_offset_ = CarrierOffset::value(increment, r);
    pending_quadrature_word_ = quadrature_dac_.step(quadrature_loop_.command());
    drive_sum_ = wrap_add(drive_sum_, pending_drive_);
    quadrature_sum_ = wrap_add(quadrature_sum_, quadrature_loop_.command());
    probe(config::tap_drive_integral, drive_loop_.integral());
    probe(config::tap_drive, pending_drive_);
    probe(config::tap_quadrature_integral, quadrature_loop_.integral());
    probe(config::tap_quadrature, quadrature_loop_.command());
    probe(config::tap_rebalance_integral, rebalance_loop_.integral());
    probe(config::tap_rebalance, rebalance_loop_.command());
    probe(config::tap_carrier_offset, pending_offset_);
    probe(config::tap_dac_quadrature, pending_quadrature_word_);
    status.raise(config::status_drive_saturated, drive_saturated);
    status.raise(config::status_quadrature_saturated, quadrature_saturated);
    status.raise(config::status_rebalance_saturated, rebalance_saturated);
    status.raise(config::status_searching, start_up_.state() == config::state_search);
    status.raise(config::status_starting,
                 start_up_.state() != config::state_open && start_up_.state() != config::state_run);
  }

  Command rebalance() const { return rebalance_loop_.command(); }

  /// Over this output interval and the one before; moves on to the next.
  CommandSum drive_sum() { return over_two(drive_sum_, last_drive_sum_); }
  CommandSum quadrature_sum() { return over_two(quadrature_sum_, last_quadrature_sum_); }

  DacWord drive_word() const { return drive_word_; }
  DacWord rebalance_word() const { return rebalance_word_; }
  DacWord quadrature_word() const { return quadrature_word_; }

 private:
  StartUp start_up_;
  ActuatorLoop drive_loop_, quadrature_loop_, rebalance_loop_;
  ShapedDac drive_dac_, rebalance_dac_, quadrature_dac_;
  Command drive_, rebalance_, pending_drive_;
  Angle offset_, pending_offset_;
  DacWord drive_word_, rebalance_word_, quadrature_word_;
  DacWord quadrature_in_force_, pending_quadrature_word_;
  CommandSum drive_sum_, last_drive_sum_, quadrature_sum_, last_quadrature_sum_;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_ACTUATORS_HPP

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/chain/arithmetic.hpp"

namespace hemi::golden {

/// Leads the instrument from rest into operation and back after a loss of signal: search sweeps the nco
/// around its start until the driven shell answers, acquire waits for lock, rise pumps the amplitude, run
/// holds it. In hold-over (rise or run with low amplitude) time runs until the search begins again.
class StartUp {
 public:
  struct Settings {
    bool control;                ///< false: measuring only
    double amplitude_threshold;  ///< all amplitudes as Polar::amplitude
    double search_amplitude;
    double closing_amplitude;
    double search_ticks;
    double search_step;  ///< turns a sample
    double search_span;  ///< turns a sample, not negative
    double holdover_ticks;
  };

  StartUp(Precision precision, const Settings& settings) : arithmetic_(precision), settings_(settings) {}

  /// locked: of the reference-phase loop, as the tick before left it.
  void tick(double amplitude, bool locked);

  config::LoopState state() const { return state_; }
  bool low() const { return low_; }                 ///< amplitude of the last tick below the threshold
  bool restart() const { return restart_; }         ///< the last tick asks the phase loop to start anew
  double search_offset() const { return offset_; }  ///< turns a sample from nco_start
  bool searching() const { return state_ == config::state_search; }
  bool starting() const {
    return searching() || state_ == config::state_acquire || state_ == config::state_rise;
  }

 private:
  void search();
  void hold_over();

  Arithmetic arithmetic_;
  Settings settings_;
  config::LoopState state_ = config::state_search;
  double search_count_ = 0.0;
  double holdover_count_ = 0.0;
  double offset_ = 0.0;
  bool low_ = false;
  bool restart_ = false;
};

}  // namespace hemi::golden

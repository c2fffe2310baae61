// SPDX-License-Identifier: Apache-2.0
// From the nominal instrument to the registers of force-to-rebalance mode.
#pragma once

#include <array>

#include "golden/loops/loop_theory.hpp"
#include "golden/physics/instrument.hpp"
#include "hls/config.hpp"

namespace hemi::loops {

/// Closed-loop -3 dB bandwidths and the start-up's levels (amplitudes in units of the set point).
struct ControlWishes {
  double reference_phase_hz = 10.0;
  double rebalance_hz = 40.0;
  double quadrature_hz = 1.0;
  double amplitude_hz = 0.5;
  double amplitude_setpoint = 1.0;  ///< in nominal amplitudes
  double hold_below = 5e-4;         ///< below this the loops hold over
  double search_until = 1.5e-3;     ///< the search ends here
  double close_at = 0.99;           ///< all loops work as in operation from here
  double search_dwell_s = 0.5;      ///< before the nco steps on
  double search_step_hz = 30.0;
  double search_span_hz = 60.0;
  double longest_holdover_s = 10.0;
  double command_limit = 0.99;  ///< of full scale, all three actuators
  double start_degc = 20.0;     ///< temperature whose frequency the nco starts from
};

/// One of the core's two instruments.
struct CoreSampling {
  double adc_rate_hz = 1e5;
  int decimation = 20;
  static CoreSampling reference() { return {1e5, 20}; }
  static CoreSampling wide() { return {2.5e5, 50}; }
};

/// Amplitude word of a tone of the ADC's full scale: half of it, times the gains of cic, image filter, table
/// and CORDIC.
double full_scale_amplitude(int decimation);

/// The four loops of one instrument, in the units of the core's words.
struct ControlDesign {
  Loop reference_phase;  ///< turns/sample in, turns out
  Loop amplitude;        ///< command in, amplitude word out
  Loop quadrature;       ///< command in, baseband word out
  Loop rebalance;
  /// Share of a carrier that a DAC passes which holds each word for one sample: sin(x)/x, x = pi f/fs at 20
  /// degC. A drive command times full scale times this is the drive that acts; the rate word has it in its
  /// gain already.
  double hold_gain = 1.0;
  double amplitude_word = 0.0;  ///< amplitude word of one nominal amplitude
  double baseband_word = 0.0;   ///< secondary baseband word of one nominal amplitude
};
ControlDesign design_control(const physics::Instrument& instrument, const CoreSampling& sampling,
                             const ControlWishes& wishes = {});

/// Sets the registers of front end, loops and start-up in `values` (config::RegisterIndex, in their units);
/// leaves those of thermometer, derivative and bias model alone. Throws std::invalid_argument for wishes that
/// cannot be had.
void set_control(std::array<double, config::register_count>& values, const physics::Instrument& instrument,
                 const CoreSampling& sampling, const ControlWishes& wishes = {});

}  // namespace hemi::loops

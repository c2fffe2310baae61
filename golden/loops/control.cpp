// SPDX-License-Identifier: Apache-2.0
#include "golden/loops/control.hpp"

#include <cmath>
#include <numbers>

#include "golden/chain/phase_detector.hpp"

namespace hemi::loops {
namespace {

using namespace config;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// What a DAC that holds each word for one sample leaves of a carrier: sin(pi f/fs) / (pi f/fs).
double hold_gain(const physics::Parameters& at20, const CoreSampling& sampling) {
  const double x = 0.5 * at20.omega_rad_s / sampling.adc_rate_hz;
  return std::sin(x) / x;
}

Loop closed_at(LoopPlant plant, double gain_per_s, double bandwidth_hz) {
  plant.gain_per_s = gain_per_s;
  return {plant, design(plant, bandwidth_hz)};
}

}  // namespace

double full_scale_amplitude(int decimation) {
  double taps = 0.0;
  for (const int tap : image_taps) taps += tap;
  const double cic = std::pow(decimation, cic_order) / std::ldexp(1.0, growth_bits(decimation, cic_order));
  return 0.5 * golden::cordic_gain() * cic * std::ldexp(taps, -image_shift) * std::ldexp(table_scale, -20);
}

ControlDesign design_control(const physics::Instrument& instrument, const CoreSampling& sampling,
                             const ControlWishes& wishes) {
  const physics::Parameters at20 = instrument.at(20.0);
  ControlDesign d;
  d.amplitude_word = instrument.pickoff_full_scale_per_amplitude * full_scale_amplitude(sampling.decimation);
  d.baseband_word = d.amplitude_word / golden::cordic_gain();
  LoopPlant plant;
  plant.adc_rate_hz = sampling.adc_rate_hz;
  plant.decimation = sampling.decimation;
  plant.delay_samples = 6.0 * sampling.decimation + 0.5;
  plant.pole_per_s = at20.damping_per_s;
  d.hold_gain = hold_gain(at20, sampling);
  d.rebalance = closed_at(plant, at20.rebalance_per_s * d.hold_gain * d.baseband_word, wishes.rebalance_hz);
  d.amplitude = closed_at(plant, at20.drive_per_s * d.hold_gain * d.amplitude_word, wishes.amplitude_hz);
  d.quadrature =
      closed_at(plant, 0.5 * at20.quadrature_span_rad_s * wishes.amplitude_setpoint * d.baseband_word,
                wishes.quadrature_hz);
  // The phase loop turns increments into phase: fs turns a second and turn a sample; a damping of 1 wants its
  // zero at a quarter of the crossover.
  plant.pole_per_s = 0.0;
  plant.delay_samples = 6.0 * sampling.decimation - 1.5;
  plant.gain_per_s = sampling.adc_rate_hz;
  d.reference_phase = {plant, design(plant, wishes.reference_phase_hz, 0.25)};
  return d;
}

void set_control(std::array<double, register_count>& v, const physics::Instrument& instrument,
                 const CoreSampling& sampling, const ControlWishes& wishes) {
  const ControlDesign d = design_control(instrument, sampling, wishes);
  const double start_hz = instrument.at(wishes.start_degc).omega_rad_s / kTurn;
  const double tick_rate_hz = sampling.adc_rate_hz / sampling.decimation;
  v[reg_nco_start] = start_hz / sampling.adc_rate_hz;
  v[reg_loop_proportional] = d.reference_phase.gains.proportional;
  v[reg_loop_integral] = d.reference_phase.gains.integral;
  // A 32nd of the frequency error a tick: slow against the six ticks of delay, fast against the loop.
  v[reg_loop_frequency] = 1.0 / (32.0 * sampling.decimation);
  v[reg_amplitude_threshold] = wishes.hold_below * d.amplitude_word;
  v[reg_lock_count] = std::round(0.025 * tick_rate_hz);
  v[reg_demodulation_cos] = 1.0;
  v[reg_demodulation_sin] = 0.0;
  v[reg_rate_gain] =
      instrument.rebalance_full_scale_dps * d.hold_gain * 3600.0 / (ticks_per_output * ticks_per_output);
  v[reg_control] = 1.0;
  v[reg_search_amplitude] = wishes.search_until * d.amplitude_word;
  v[reg_closing_amplitude] = wishes.close_at * wishes.amplitude_setpoint * d.amplitude_word;
  v[reg_search_ticks] = std::round(wishes.search_dwell_s * tick_rate_hz);
  v[reg_search_step] = wishes.search_step_hz / sampling.adc_rate_hz;
  v[reg_search_span] = wishes.search_span_hz / sampling.adc_rate_hz;
  v[reg_holdover_ticks] = std::round(wishes.longest_holdover_s * tick_rate_hz);
  v[reg_modulation_phase] = 0.0;
  v[reg_modulation_delay] = 2.5;
  v[reg_amplitude_setpoint] = wishes.amplitude_setpoint * d.amplitude_word;
  v[reg_amplitude_proportional] = d.amplitude.gains.proportional;
  v[reg_amplitude_integral] = d.amplitude.gains.integral;
  v[reg_drive_start] = wishes.amplitude_setpoint / instrument.drive_full_scale_over_steady / d.hold_gain;
  v[reg_drive_limit] = wishes.command_limit;
  v[reg_quadrature_proportional] = d.quadrature.gains.proportional;
  v[reg_quadrature_integral] = d.quadrature.gains.integral;
  v[reg_quadrature_start] = 0.0;
  v[reg_quadrature_limit] = wishes.command_limit;
  v[reg_rebalance_proportional] = d.rebalance.gains.proportional;
  v[reg_rebalance_integral] = d.rebalance.gains.integral;
  v[reg_rebalance_limit] = wishes.command_limit;
}

}  // namespace hemi::loops

// SPDX-License-Identifier: Apache-2.0
// The nominal instrument: what a maker would print in its data sheet. A scenario may change any of it.
#pragma once

#include <array>
#include <vector>

#include "golden/physics/parameters.hpp"

namespace hemi::physics {

/// At which an instrument\'s quality factor and split are stated.
inline constexpr double kReferenceDegc = 20.0;

/// Nominal values of a 30 mm instrument with quality factor 1e7; sources in docs/physics.md.
struct Instrument {
  // frequency and damping over the shell's temperature; ascending polynomials about the reference
  // temperatures
  double frequency_reference_degc = 0.0;
  std::vector<double> frequency_hz = {4424.90095, 0.371555556, -9.70238095e-4, 1.52777778e-5};
  double quality_factor = 1e7;                          ///< at 20 degC
  std::vector<double> relative_damping = {1.0, 0.002};  ///< 1/tau over its value at 20 degC, of (T - 20 degC)
  double kappa = 0.554;
  double centrifugal = 0.11;       ///< of no consequence below 1e4 deg/s
  double damping_mismatch = 0.01;  ///< d tau
  double damping_axis_deg = 11.25;
  double split_hz = 1e-3;
  double split_axis_deg = 22.5;
  std::vector<double> relative_split = {1.0, 0.002};  ///< of (T - 20 degC)

  // full scales (fractions: DAC word over 2^15)
  double rebalance_full_scale_dps = 120.0;
  double drive_full_scale_over_steady = 400.0;
  double quadrature_full_scale_hz = 0.05;
  double drive_full_scale_v = 10.0;  ///< telemetry volts at full scale
  double quadrature_full_scale_v = 10.0;
  double pickoff_full_scale_per_amplitude = 0.8;

  // noise
  double pickoff_noise_lsb = 0.5;  ///< rms a sample at the ADC, white, 16 bit LSB
  double force_noise_dph_rthz =
      0.5;                        ///< white force noise on each axis, as rate at nominal amplitude, one-sided
  double rate_flicker_dph = 0.0;  ///< 1/f part: flicker floor
  double oscillator_noise_rthz = 0.0;  ///< white fractional frequency noise
  double case_thermometer_noise_degc = 0.005;
  double case_thermometer_step_degc = 0.01;

  // thermal network (single poles in a chain; 0: no lag)
  double case_time_constant_s = 600.0;    ///< chamber -> case
  double stem_time_constant_s = 0.0;      ///< case -> stem
  double shell_time_constant_s = 2600.0;  ///< stem -> shell
  double board_rise_degc = 8.0;           ///< board over case, settled
  double board_time_constant_s = 900.0;   ///< of that rise after power-on

  // drift that the paper's Eq. (21) describes: B(f, df/dt) [deg/h] of the true frequency
  double bias_reference_hz = 4432.07;
  std::array<double, 10> bias_terms_dph{};  ///< 1 f f^2 f^3 df df^2 df^3 f df f^2 df f df^2

  /// Parameters at a shell temperature, at rest, nothing left out.
  Parameters at(double shell_degc) const;
};

}  // namespace hemi::physics

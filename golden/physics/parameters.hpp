// SPDX-License-Identifier: Apache-2.0
// What the plant is made of: the nominal instrument, and its parameters at one instant.
#pragma once

#include <array>
#include <numbers>

namespace hemi::physics {

inline constexpr double kTwoPi = 2.0 * std::numbers::pi;
inline constexpr double kRadPerSecondPerDph = std::numbers::pi / (180.0 * 3600.0);

/// The instrument at one instant, as the resonator's equations use it (docs/physics.md). Displacements are in
/// units of the nominal amplitude; a command of 1 is the full scale of its DAC.
///
///   x'' - kappa (2 W y' + W' y) + (2/tau) x' + d (x' cos 2th_tau + y' sin 2th_tau)
///       + (w^2 - kp W^2) x - w dw (x cos 2th_w + y sin 2th_w) + nonlinear = fx
///   y'' + kappa (2 W x' + W' x) + (2/tau) y' + d (x' sin 2th_tau - y' cos 2th_tau)
///       + (w^2 - kp W^2) y - w dw (x sin 2th_w - y cos 2th_w) + nonlinear = fy
///
/// with dw cos 2th_w -> split_cos, dw sin 2th_w -> split_sin + quadrature_span q (q: quadrature command).
/// Source: Lynch, "Coriolis vibratory gyros", Symposium Gyro Technology, Stuttgart 1998; averaged form in
/// docs/physics.md.
struct Parameters {
  // resonator
  double omega_rad_s = 0.0;          ///< w, mean natural frequency
  double damping_per_s = 0.0;        ///< 1/tau, mean; the amplitude decays as exp(-t/tau)
  double mismatch_cos_per_s = 0.0;   ///< d cos 2th_tau
  double mismatch_sin_per_s = 0.0;   ///< d sin 2th_tau
  double split_cos_rad_s = 0.0;      ///< dw cos 2th_w
  double split_sin_rad_s = 0.0;      ///< dw sin 2th_w
  double kappa = 0.0;                ///< angular gain: 2 x Bryan's factor
  double centrifugal = 0.0;          ///< kp
  double cubic_stiffness = 0.0;      ///< + w^2 k3 (x^2 + y^2) (x, y): df/f = (3/8) k3 A^2
  double quadratic_stiffness = 0.0;  ///< + w^2 k2 x^2 (and y^2)
  double quadratic_damping =
      0.0;  ///< + (2/tau) (3 pi/8) c2 (|v|/w) v, v = (x', y'): 1/tau -> (1/tau)(1 + c2 A)
  double cubic_damping_per_s =
      0.0;  ///< + (8/3) c3 (|v|/w)^2 v: 1/tau -> 1/tau + c3 A^2, A one mode's amplitude
  // rate as the resonator feels it
  double rate_rad_s = 0.0;         ///< W
  double rate_slope_rad_s2 = 0.0;  ///< W'
  // actuators; amplitude growth [1/s] of the primary by a drive command of 1, and so on
  double drive_per_s = 0.0;
  double rebalance_per_s = 0.0;
  double quadrature_span_rad_s = 0.0;  ///< stiffness (dw sin 2th_w) by a quadrature command of 1
  double forcer_misalignment_rad =
      0.0;  ///< a: part of the drive's force that acts on y, fy += a fx of the drive
  // pickoffs: ADC fraction of full scale = full_scale_per_amplitude gain (x + a2 x^2 + a3 x^3) + feedthrough
  // drive
  double pickoff_gain_x = 1.0;
  double pickoff_gain_y = 1.0;
  double pickoff_quadratic = 0.0;    ///< a2, x in nominal amplitudes
  double pickoff_cubic = 0.0;        ///< a3
  double pickoff_phase_y_rad = 0.0;  ///< y's electronics lead x's by this: an error of the demodulation phase
  double drive_feedthrough = 0.0;    ///< of the drive DAC into pickoff x, in fractions of ADC full scale
  // converters and clock
  std::array<double, 2> adc_offset_lsb{};  ///< x and y, LSB of 16 bit whatever the ADC
  double adc_inl_lsb = 0.0;                ///< peak of the integral non-linearity, LSB of 16 bit
  double adc_clip = 1.0;                   ///< level at which the front end clips, fraction of full scale
  double oscillator_error = 0.0;           ///< y: counted frequency = f (1 - y)

  bool operator==(const Parameters&) const = default;
};

/// Node temperatures. The case thermometer reads case_degc.
struct Temperatures {
  double case_degc = 20.0;
  double stem_degc = 20.0;
  double shell_degc = 20.0;
  double board_degc = 20.0;
};

/// Inputs at one instant: what chamber, table and user do.
struct Environment {
  double time_s = 0.0;
  double chamber_degc = 20.0;
  double rate_dph = 0.0;          ///< turntable along the sensing axis, Earth rate included
  double rate_slope_dph_s = 0.0;  ///< its derivative
  double accel_g = 0.0;           ///< specific force along the sensing axis
  double supply_v = 5.0;
  double amplitude_setpoint = 1.0;
  double quadrature_trim_v = 0.0;
  double power_on_s = 0.0;         ///< when the electronics was switched on
  double board_heater_degc = 0.0;  ///< what a heater on the board adds to it, settled
};

}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
// Linear theory of the four loops: open and closed loop as functions of frequency, with every delay of the
// chain.
#pragma once

#include <complex>

namespace hemi::loops {

/// What one loop controls, seen from its command to the word that its controller reads.
///
///   P(s) = gain / (s + pole) x hold(s) x front_end(s) x exp(-s delay)
///
/// hold: a command stays for one tick, sinc(f R / fs); front_end: the cic's amplitude response to the power
/// of its order. From the last sample of tick k the word describes 5 (R-1)/2 + 2 R samples earlier; its
/// command is in force for the samples R+1 .. 2R later and acts two samples after each of them, for one
/// sample: in the mean 6 R + 1/2 samples from motion to force (docs/chain.md). The phase loop has no DAC: 2.5
/// samples less, and half a sample of the nco more.
struct LoopPlant {
  double gain_per_s = 0.0;  ///< growth of the controller's input word a second for a command of 1
  double pole_per_s = 0.0;  ///< 1/tau; 0: an integrator
  double adc_rate_hz = 0.0;
  int decimation = 0;  ///< R, samples a tick
  double delay_samples = 0.0;

  std::complex<double> response(double frequency_hz) const;
};

/// Proportional gain, and integral gain a tick: C = kp + ki / (1 - z^-1), z = exp(s R / fs).
struct LoopGains {
  double proportional = 0.0;
  double integral = 0.0;
};

/// One loop closed.
struct Loop {
  LoopPlant plant;
  LoopGains gains;

  /// L(f) = C P.
  std::complex<double> open(double frequency_hz) const;
  /// T(f) = L / (1 + L): from a disturbance at the plant's input to the (negative) command, or from set point
  /// to output.
  std::complex<double> closed(double frequency_hz) const;
  double crossover_hz() const;      ///< |L| = 1, the highest such frequency
  double phase_margin_deg() const;  ///< 180 + arg L at crossover
  double bandwidth_hz() const;      ///< |T| = 1/sqrt(2), the highest such frequency below half the tick rate
};

/// Gains whose closed loop is 3 dB down at `bandwidth_hz`, with the controller's zero at `zero_ratio` of the
/// crossover of a pure integrator: ki = kp wz R/fs. Throws std::invalid_argument when the delay leaves less
/// than `least_margin_deg`.
LoopGains design(const LoopPlant& plant, double bandwidth_hz, double zero_ratio = 0.1,
                 double least_margin_deg = 60.0);

}  // namespace hemi::loops

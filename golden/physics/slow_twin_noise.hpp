// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "golden/physics/slow_twin.hpp"
#include "golden/physics/slow_twin_loops.hpp"

namespace hemi::physics {

/// The instrument's noise in its telemetry, derived from that of pickoffs, forces, oscillator and
/// thermometer.
///
/// A pickoff noise of s rms a sample (rounding, 1/12 LSB^2, included) at the ADC rate fs becomes, behind the
/// demodulator, noise of one-sided density S_n = 4 s^2/fs in phase and in quadrature [nominal
/// amplitudes^2/Hz]; a force noise that is N as a rate pushes each of the four quadratures by S_F = (kappa
/// N)^2 [1/s^2/Hz].
///
///     rate, drive, quadrature, amplitude   S_F and S_n through their loops, exactly averaged (LoopNoise)
///     frequency   white sqrt(S_F)/(2 pi A); and (p_i - p_(i-1))/(2 pi dt), p the phase averaged over one
///     output interval T of
///                 the core, of variance S_n/(2 T A^2): rising with frequency
///                 and the oscillator's: white
class SlowTwinNoise {
 public:
  SlowTwinNoise(const Instrument& instrument, const SlowTwinOptions& options, double dt_s);

  /// Adds one sample's noise. amplitude: true one.
  void add(const Parameters& p, double amplitude, TelemetrySample& sample);

 private:
  const Instrument& instrument_;
  double dt_s_;
  double white_frequency_hz_;  ///< rms at nominal amplitude
  double phase_rad_;           ///< rms of p at nominal amplitude
  double former_phase_rad_;
  double oscillator_;  ///< rms, fractional
  LoopNoise rebalance_;
  LoopNoise quadrature_;
  LoopNoise amplitude_;
  std::optional<FlickerNoise> flicker_;
  Gaussian gaussian_;
};

}  // namespace hemi::physics

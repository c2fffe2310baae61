// SPDX-License-Identifier: Apache-2.0
// Noise budget of force-to-rebalance mode: from the densities of the sources to the Allan deviation of the
// records.
#pragma once

#include <vector>

#include "golden/loops/control.hpp"
#include "golden/loops/loop_theory.hpp"
#include "golden/physics/instrument.hpp"

namespace hemi::loops {

/// Independent sources' shares of one density or variance; all in the same squared unit, so that they add.
struct NoiseParts {
  double pickoff = 0.0;     ///< noise of the pickoffs' electronics
  double adc = 0.0;         ///< ADC rounding, LSB^2/12 a sample
  double force = 0.0;       ///< white force on both axes
  double dac = 0.0;         ///< DAC rounding behind first-order error feedback
  double oscillator = 0.0;  ///< white fractional frequency of the clock
  double total() const { return pickoff + adc + force + dac + oscillator; }
};

/// Noise of rate and frequency at rest and constant temperature, all loops closed and settled. Linear theory
/// (docs/noise.md): densities at the loop rate, then the records' triangular weights and the Allan filter.
///
/// All densities are one-sided, frequency_hz in (0, half the tick rate]; no frequency is exactly 0.
class NoiseBudget {
 public:
  /// adc_bits: 16 or more. Throws std::invalid_argument for fewer, or for wishes that cannot be had.
  NoiseBudget(const physics::Instrument& instrument, const CoreSampling& sampling, int adc_bits,
              const ControlWishes& wishes = {});

  /// Rebalance command of every tick in units of rate, (deg/h)^2/Hz.
  ///
  ///   S = |C/(1+L)|^2 K^2 S_word + |L/(1+L)|^2 (N^2 + S_dac)
  NoiseParts rate_density(double frequency_hz) const;

  /// Total phase of every tick, turns^2/Hz.
  ///
  ///   S = |(1 + L/F)/(1 + L)|^2 (S_detector + F^2 S_frequency / (2 pi f)^2)
  NoiseParts phase_density(double frequency_hz) const;

  /// Allan variance of the 200 Hz records over `averaged` >= 1 of them, (deg/h)^2 and (nominal Hz)^2:
  /// integral of the density times the records' and the Allan filter. Neighbouring records overlap.
  NoiseParts rate_allan_variance(long averaged) const;
  NoiseParts frequency_allan_variance(long averaged) const;

  /// Their square roots; tau_s: a whole number of record intervals, else std::invalid_argument.
  double rate_allan_dph(double tau_s) const;
  double frequency_allan_hz(double tau_s) const;

  double tick_rate_hz() const { return tick_rate_hz_; }
  double record_rate_hz() const;

 private:
  /// Density of one channel's baseband word for ADC noise of unit variance a sample (fraction^2), 1/Hz.
  double word_density(double frequency_hz) const;
  /// Cic and image filter, 1 at frequency 0; real, as their response is symmetrical.
  double front_end(double frequency_hz) const;
  long whole_records(double tau_s) const;

  ControlDesign design_;
  double tick_rate_hz_;
  double adc_rate_hz_;
  int decimation_;
  double setpoint_;
  std::vector<double> word_correlation_;  // of the word, for lags of 0, 1, ... ticks
  double pickoff_variance_;               // fraction of full scale, a sample
  double adc_variance_;
  double rate_of_command_dph_;
  double force_dph2_hz_;      // as rate
  double dac_dph2_hz_;        // as rate
  double force_hz2_hz_;       // as frequency
  double dac_hz2_hz_;         // as frequency
  double oscillator_hz2_hz_;  // as frequency
};

}  // namespace hemi::loops

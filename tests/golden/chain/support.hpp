// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "golden/chain/budget.hpp"
#include "golden/chain/chain.hpp"

namespace hemi::golden::testing {

/// Registers of a loop with damping 1 and 10 Hz of closed-loop bandwidth (wn = 2 pi 10 / 2.482: for
/// H = (2 wn s + wn^2) / (s + wn)^2, |H|^2 = 1/2 at 2.482 wn), on their grids; compensation off.
RegisterValues reference_values(const InstrumentParameters& instrument, double start_hz);

/// a cos(2 pi (f n / fs + phase)) in units of full scale, its phase kept modulo one turn.
class Tone {
 public:
  Tone(double frequency_hz, double adc_rate_hz, double amplitude, double phase_turns = 0.0)
      : step_(frequency_hz / adc_rate_hz), amplitude_(amplitude), phase_(phase_turns) {}
  Eigen::VectorXd next(Eigen::Index count);

 private:
  double step_;
  double amplitude_;
  double phase_;
};

/// White Gaussian noise.
class Noise {
 public:
  explicit Noise(unsigned seed) : engine_(seed) {}
  Eigen::VectorXd next(Eigen::Index count, double sigma);

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

/// Fractions of full scale to ADC words: nearest, clipped at the rails.
Eigen::VectorXd digitise(const Eigen::VectorXd& fraction, int adc_bits);

/// Word of each record.
Eigen::VectorXd column(const std::vector<ChainRecord>& records, config::RecordWord word,
                       std::size_t from = 0);

/// Amplitudes of the lines of a real series about its mean, Hann window, one bin a 1/size of the sample rate.
/// A line between two bins comes out up to 1.42 dB low (factor 0.849).
Eigen::VectorXd line_spectrum(const Eigen::VectorXd& series);

/// Slope of a least-squares line through equally spaced values, a step.
double line_slope(const Eigen::VectorXd& values);

}  // namespace hemi::golden::testing

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "golden/concealed/random.hpp"

namespace hemi::concealed {

using Series = Eigen::ArrayXd;

/// The numbers of one instrument, those that a model file states.
struct Model {
  std::vector<double> frequency_hz{};  ///< ascending in T [degC]
  double time_constant_s = 0.0;        ///< of the resonator behind the case
  double reference_hz = 4432.07;       ///< of f in the bias
  std::array<double, 10> bias_dph{};   ///< 1 f f^2 f^3 df df^2 df^3 f*df f^2*df f*df^2
  double scale_factor = 1.0;
  double command_reference_degc = 20.0;  ///< of the two below
  std::vector<double> drive_v{};         ///< ascending in T - command_reference_degc
  std::vector<double> quadrature_v{};
};

/// One channel's noise, one-sided amplitude spectral densities at 1 Hz.
struct NoiseLevel {
  double white = 0.0;
  double flicker = 0.0;      ///< falls with the root of frequency
  double random_walk = 0.0;  ///< falls with frequency
  double differenced = 0.0;  ///< rises with frequency: differences of a white phase
  enum class Shape { kGauss, kHeavyTailed, kLaplace } shape = Shape::kGauss;  ///< of the white part
};

/// What is not in the model's equations, and no effect either.
struct Nuisance {
  double lag_s = 0.0;              ///< of everything behind the case, up to a sample
  double start_offset_degc = 0.0;  ///< resonator minus case when the recording starts
  double case_noise_degc = 0.01;   ///< standard deviation before rounding
  double case_step_degc = 0.01;    ///< rounding of the case thermometer
  double rate_step_dph = 1e-4;     ///< rounding of the rate output
};

enum Output { kFrequency, kDrive, kQuadrature, kRate, kOutputs };

struct Instrument {
  Model model{};
  std::array<NoiseLevel, kOutputs> noise{};
  NoiseLevel amplitude_noise{};
  Nuisance nuisance{};
  double board_lag_s = 0.0;  ///< of the board behind the case
  double board_rise_degc = 0.0;
};

/// Polynomial, ascending coefficients.
Series polynomial(const std::vector<double>& coefficients, const Series& x);

/// Eq. (21) of the paper: f relative to reference_hz [Hz], df [Hz/s]; deg/h.
Series bias(const Model& model, const Series& frequency_hz, const Series& slope_hz_per_s);

Instrument random_instrument(Random& random);

}  // namespace hemi::concealed

// SPDX-License-Identifier: Apache-2.0
// A pickoff's samples as a vibration of slowly changing amplitude and phase, its harmonics, and the rest.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace hemi::diagnosis {

/// The vibration at each sample: x = amplitude cos(phase) + harmonics + rest.
struct Vibration {
  Eigen::VectorXcd turn;          ///< exp(j phase)
  Eigen::VectorXd amplitude_lsb;  ///< of the fundamental
  double frequency_hz = 0.0;      ///< mean
};

/// Harmonics bound to the phase of the vibration, by least squares over all samples:
///     x - amplitude cos(phase) = c0 + sum_k c_k cos(k phase) + s_k sin(k phase),   k of `order` (never 1)
struct Harmonics {
  std::vector<int> order;       ///< k of each pair; those that fold onto a lower one are left out
  Eigen::VectorXd value_lsb;    ///< c0, all c_k, all s_k
  Eigen::MatrixXd information;  ///< inverse covariance of `value_lsb`, for white noise of `noise_lsb`
  double noise_lsb = 0.0;       ///< rms of what is left
  double amplitude_lsb = 0.0;   ///< mean fundamental
};

struct ToneFit {
  Vibration vibration;
  Harmonics harmonics;
  Eigen::VectorXd rest_lsb;
};

/// Fits both in turn until they no longer disturb each other. Amplitude and phase are quadratic in time over
/// pieces of `piece` samples. Throws std::invalid_argument for fewer than two pieces or samples without a
/// vibration.
ToneFit fit_tones(const Eigen::VectorXd& samples_lsb, double sample_rate_hz, Eigen::Index piece);

/// A signal without its part at a vibration's phase, quadratic in time over each piece. A constant stays.
Eigen::VectorXd without_fundamental(const Eigen::VectorXd& signal, const Eigen::VectorXcd& turn,
                                    Eigen::Index piece);

/// What fundamental and harmonics explain, taken off a signal of the same length: the fundamental's quadratic
/// over each piece, c0 and the harmonics. For regressors of a test on ToneFit::rest_lsb.
Eigen::VectorXd without_tones(const Eigen::VectorXd& signal, const ToneFit& fit, Eigen::Index piece);

/// Complex amplitudes Z of a signal against a vibration's phase, z = Re(Z exp(j phase)) + constant in the
/// middle of each block of `block` samples, by least squares; Z is linear in time within a block.
Eigen::VectorXcd block_amplitudes(const Eigen::VectorXd& signal, const Eigen::VectorXcd& turn,
                                  Eigen::Index block);

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
// What the DAC words tell: drive that leaks into the primary pickoff, and the phase between the forces and
// what they move.
#pragma once

#include <Eigen/Core>

#include "golden/diagnosis/stage_tones.hpp"

namespace hemi::diagnosis {

/// An estimate and its standard deviation.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;
  double z() const { return sigma > 0.0 ? value / sigma : 0.0; }
};

/// Leak of the drive's words into a pickoff, each over its full scale. `rest_lsb` and `words` are free of
/// fundamental and harmonics, so that what speaks is the rounding of the words, which the core's error
/// feedback spreads over all frequencies; words[n] is the one held when sample n was taken. White noise of
/// `noise_lsb`.
Estimate leak(const Eigen::VectorXd& rest_lsb, const Eigen::VectorXd& words, double noise_lsb);

/// Blocks of both pickoffs and of the words, against the phase of the primary.
struct Blocks {
  double seconds = 0.0;        ///< a block
  double omega_rad_s = 0.0;    ///< of the primary
  Eigen::VectorXd amplitude;   ///< primary, nominal amplitudes
  Eigen::VectorXd phase_rad;   ///< primary, against a steady clock
  Eigen::VectorXcd secondary;  ///< likewise, phase of the primary taken off: Y
  Eigen::VectorXcd drive;      ///< words over full scale, likewise; real: force in phase with the velocity
  Eigen::VectorXcd rebalance;
  Eigen::VectorXd quadrature;      ///< words over full scale
  double primary_noise_rad = 0.0;  ///< of phase_rad, white
  double secondary_noise = 0.0;    ///< of each part of `secondary`, white
};

/// Phase of the secondary's electronics against the primary's:
///     Im Y = tan(phase) Re Y + polynomial(t) + integrals of A (split), q A (quadrature electrode), Re Y (the
///     other axis of the split), Im R and Im D (forces beside their phase while the loop locks)
/// A force beside which Re Y grows by g R a second moves Im Y by g R/(2 w) at once (the part of its response
/// that does not grow; second order in the averaging); that is taken off. A rate, known or not, and whatever
/// balances it move Re Y alone, so that they speak for the phase and cannot be mistaken for it.
Estimate secondary_phase_rad(const Blocks& blocks, double rebalance_per_s);

/// Phase of the drive's force against the velocity, from what a changing drive does to the phase:
///     phase = tan(force phase) integral(g D/A) + leak D/A + polynomial(t) + integrals of Re Y/A, Im Y/A, Im
///     D/A
/// g: growth per second of a full-scale drive; the last are split, rate, and force while the loop locks.
Estimate drive_force_rad(const Blocks& blocks, double drive_per_s);

}  // namespace hemi::diagnosis

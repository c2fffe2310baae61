// SPDX-License-Identifier: Apache-2.0
// Exact step of the resonator's linear equations over one sample with the forces held.
#pragma once

#include <Eigen/Core>

#include "golden/physics/parameters.hpp"

namespace hemi::physics {

/// z(t + h) = z + change z + response (fx, fy), z = (x, x'/s, y, y'/s), s a fixed velocity scale, forces
/// constant over h. The change Phi - 1 is kept instead of Phi: a step turns the state by 0.3 rad but damps it
/// by 1e-8, and the rounding of 1 - 1e-8 would cost as much damping accuracy as the whole exponential does
/// otherwise.
struct Propagator {
  Eigen::Matrix4d change;
  Eigen::Matrix<double, 4, 2> response;
};

/// The linear part of the equations of Parameters, without the quadrature command. step_s: h > 0;
/// velocity_scale_rad_s: s > 0, best near w. Accuracy: a few 1e-17 in every entry of `change` while w h < 0.3
/// (Taylor to order 13 by Paterson and Stockmeyer, SIAM J. Comput. 2 (1973) 60); longer steps are halved
/// first and squared after.
Propagator make_propagator(const Parameters& parameters, double step_s, double velocity_scale_rad_s);

}  // namespace hemi::physics

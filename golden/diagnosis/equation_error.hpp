// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace hemi::diagnosis {

/// First guess of (b, d, k1, c) by least squares of y'' + d y' + k1 y = b u + c, the derivatives taken in the
/// frequency domain from the tapered record; a tenth at either end is left out of the fit. Biased by noise,
/// which the derivatives amplify: a start for the simulation error and nothing more. std::invalid_argument
/// for fewer than 64 rows, RankDeficiencyError where the force does not move.
Eigen::Vector4d equation_error_start(const Eigen::VectorXd& force_v, const Eigen::VectorXd& displacement_v,
                                     double sample_rate_hz);

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
// The resonator's equations written out once more, and integrated adaptively in long double.
#pragma once

#include <array>

#include "golden/physics/resonator.hpp"

namespace hemi::physics::testing {

/// Forces per mass and quadrature command, all constant.
struct Inputs {
  double fx = 0.0;
  double fy = 0.0;
  double quadrature = 0.0;
};

/// The motion `duration_s` later, by the Bulirsch-Stoer method of Boost.Odeint. tolerance: of each of its
/// steps, absolute and relative, in units of amplitude and of velocity over w.
Motion integrate(const Parameters& parameters, const Motion& start, const Inputs& inputs, double duration_s,
                 double tolerance);

}  // namespace hemi::physics::testing

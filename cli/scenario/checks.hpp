// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/scenario/scenario.hpp"
#include "cli/scenario/section.hpp"

namespace hemi::scenario {

/// Refuses what an instrument cannot do, by InputError at the key that asks for it:
/// - f(T) that is not monotonic, not finite or not positive over the chamber's temperatures;
/// - damping that is not above zero there;
/// - an amplitude that the drive's full scale cannot hold, or that overloads the ADC;
/// - rates beyond the rebalance loop's full scale, and a split beyond the quadrature electrode's;
/// - in mode full, a resonator that the core cannot follow, a loop whose bandwidth its delay does not allow,
/// and inputs
///   that the core does not have.
void check_physics(const Scenario& scenario, const Section& file);

}  // namespace hemi::scenario

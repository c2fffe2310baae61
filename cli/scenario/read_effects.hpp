// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cli/scenario/section.hpp"
#include "golden/physics/world.hpp"

namespace hemi::scenario {

/// The effect with every parameter, typical values where none is given. InputError for ids and parameters
/// that the catalogue does not know and for values outside the possible range.
physics::ActiveEffect completed_effect(const physics::ActiveEffect& effect, const Where& where);

/// [[effect]] tables: id, and parameters by name, plain in the catalogue's unit or as text with a unit.
std::vector<physics::ActiveEffect> read_effects(const Section& scenario,
                                                const physics::Instrument& instrument);

/// The catalogue's entry; InputError with the nearest id.
const physics::CatalogueEntry& find_effect(std::string_view id, const Where& where);

}  // namespace hemi::scenario

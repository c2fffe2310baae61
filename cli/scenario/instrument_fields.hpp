// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "cli/scenario/section.hpp"
#include "golden/physics/instrument.hpp"

namespace hemi::scenario {

/// A number of physics::Instrument that a scenario may set by name.
struct NumberField {
  std::string_view name;
  Quantity quantity;
  double physics::Instrument::*member;
};

/// An ascending polynomial of physics::Instrument; `unit` is that of the first coefficient.
struct PolynomialField {
  std::string_view name;
  std::string_view unit;
  std::vector<double> physics::Instrument::*member;
};

std::span<const NumberField> number_fields();
std::span<const PolynomialField> polynomial_fields();

/// Sets what [instrument] and [instrument.bias] say, on top of `base`. `model` is left to the caller.
/// InputError for unknown keys, wrong units and impossible values.
physics::Instrument read_instrument(const Section& section, const physics::Instrument& base);

/// The same instrument without any noise.
physics::Instrument without_noise(physics::Instrument instrument);

}  // namespace hemi::scenario

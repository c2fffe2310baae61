// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "golden/physics/effect.hpp"

namespace hemi::physics {

namespace {

using Catalogue = std::map<std::string, CatalogueEntry, std::less<>>;

// Inside a function: registrations run before main in an order that nobody defines.
Catalogue& entries() {
  static Catalogue all;
  return all;
}

std::string names_of(const EffectDescription& description) {
  std::string names;
  for (const EffectParameter& parameter : description.parameters) {
    names += (names.empty() ? "" : ", ") + parameter.name;
  }
  return names;
}

EffectValues completed(const EffectDescription& description, const EffectValues& given) {
  EffectValues values;
  for (const EffectParameter& parameter : description.parameters) values[parameter.name] = parameter.typical;
  for (const auto& [name, value] : given) {
    const auto parameter = std::find_if(description.parameters.begin(), description.parameters.end(),
                                        [&name = name](const EffectParameter& p) { return p.name == name; });
    if (parameter == description.parameters.end()) {
      throw std::invalid_argument(fmt::format("effect {}: unknown parameter '{}'; it has {}", description.id,
                                              name, names_of(description)));
    }
    // Written so that a value that is not a number is refused, too.
    if (!(value >= parameter->lowest && value <= parameter->highest)) {
      throw std::invalid_argument(fmt::format("effect {}: {} = {} {} is outside {} .. {} {}", description.id,
                                              name, value, parameter->unit, parameter->lowest,
                                              parameter->highest, parameter->unit));
    }
    values[name] = value;
  }
  return values;
}

}  // namespace

const Catalogue& catalogue() {
  return entries();
}

Registration::Registration(EffectDescription description, EffectMaker make) {
  const std::string id = description.id;
  CatalogueEntry entry;
  entry.make = [description, make = std::move(make)](const EffectValues& values, const Instrument& instrument,
                                                     std::uint64_t seed) {
    return make(completed(description, values), instrument, seed);
  };
  entry.description = std::move(description);
  if (!entries().emplace(id, std::move(entry)).second) {
    throw std::logic_error(fmt::format("effect {} is registered twice", id));
  }
}

}  // namespace hemi::physics

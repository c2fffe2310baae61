// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/read_effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "cli/recording/error.hpp"

namespace hemi::scenario {
namespace {

using physics::EffectDescription;
using physics::EffectParameter;

std::vector<std::string_view> parameter_names(const EffectDescription& description) {
  std::vector<std::string_view> names;
  for (const EffectParameter& parameter : description.parameters) names.push_back(parameter.name);
  return names;
}

Quantity quantity_of(const EffectParameter& parameter) {
  return {parameter.unit, parameter.lowest, parameter.highest};
}

physics::ActiveEffect read_effect(const Section& section, const physics::Instrument& instrument) {
  if (!section.has("id")) section.refuse("id", "is missing", "add id = \"...\"; hemi effects lists them");
  const EffectDescription& description = find_effect(section.text("id", ""), section.where("id")).description;
  std::vector<std::string_view> known = parameter_names(description);
  known.insert(known.begin(), "id");
  section.allow(known);
  physics::ActiveEffect effect{description.id, {}};
  for (const EffectParameter& parameter : description.parameters)
    effect.values[parameter.name] =
        section.quantity(parameter.name, quantity_of(parameter), parameter.typical);
  try {
    find_effect(effect.id, section.where()).make(effect.values, instrument, 0);
  } catch (const std::invalid_argument& error) {
    refuse(section.where(), error.what(), fmt::format("see hemi effects {}", effect.id));
  }
  return effect;
}

}  // namespace

const physics::CatalogueEntry& find_effect(std::string_view id, const Where& where) {
  const auto found = physics::catalogue().find(id);
  if (found != physics::catalogue().end()) return found->second;
  std::vector<std::string_view> ids;
  for (const auto& [known, entry] : physics::catalogue()) ids.push_back(known);
  const std::string nearest = nearest_name(id, ids);
  refuse(where, fmt::format("no effect {} in the catalogue", recording::in_quotes(id)),
         fmt::format("{}hemi effects lists all {}",
                     nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest), ids.size()));
}

physics::ActiveEffect completed_effect(const physics::ActiveEffect& effect, const Where& where) {
  const EffectDescription& description = find_effect(effect.id, where).description;
  physics::ActiveEffect completed{effect.id, {}};
  for (const EffectParameter& parameter : description.parameters) {
    const auto given = effect.values.find(parameter.name);
    const double value = given == effect.values.end() ? parameter.typical : given->second;
    completed.values[parameter.name] = read_quantity(
        {where.line, value}, quantity_of(parameter),
        {where.path, fmt::format("{}.{}.{}", where.name, effect.id, parameter.name), where.line});
  }
  for (const auto& [name, value] : effect.values) {
    if (completed.values.contains(name)) continue;
    refuse(where, fmt::format("{} has no parameter {}", effect.id, recording::in_quotes(name)),
           fmt::format("known: {}", fmt::join(parameter_names(description), ", ")));
  }
  return completed;
}

std::vector<physics::ActiveEffect> read_effects(const Section& scenario,
                                                const physics::Instrument& instrument) {
  std::vector<physics::ActiveEffect> effects;
  if (!scenario.has("effect")) return effects;
  for (const Value& item : scenario.list("effect")) {
    const auto* table = std::get_if<Table>(&item.content);
    const Where where{scenario.where().path, "effect", item.line};
    if (table == nullptr) refuse(where, "expected a table", "write [[effect]] and its keys below");
    effects.push_back(read_effect(Section(*table, where), instrument));
  }
  return effects;
}

}  // namespace hemi::scenario

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/commands.hpp"
#include "cli/recording/json.hpp"
#include "cli/scenario/read_effects.hpp"

namespace hemi::cli {
namespace {

using physics::EffectDescription;

struct EffectsOptions {
  std::string id;
  bool json = false;
};

recording::Json as_json(const EffectDescription& d) {
  recording::Json json = {{"id", d.id},
                          {"equation", d.equation},
                          {"explanation", d.explanation},
                          {"channels", d.channels},
                          {"confused_with", d.confused_with},
                          {"separated_by", d.separated_by}};
  json["parameters"] = recording::Json::array();
  for (const auto& p : d.parameters) {
    json["parameters"].push_back({{"name", p.name},
                                  {"unit", p.unit},
                                  {"typical", p.typical},
                                  {"lowest", p.lowest},
                                  {"highest", p.highest},
                                  {"meaning", p.meaning}});
  }
  return json;
}

void print_one(const EffectDescription& d) {
  fmt::print("{}\n\n  {}\n\n{}\n\n", d.id, d.equation, d.explanation);
  fmt::print("Seen in        {}\n", fmt::join(d.channels, ", "));
  if (!d.confused_with.empty()) fmt::print("Mistaken for   {}\n", fmt::join(d.confused_with, ", "));
  if (!d.separated_by.empty()) fmt::print("Separated by   {}\n", d.separated_by);
  fmt::print("\nParameters: typical value, possible range\n");
  for (const auto& p : d.parameters) {
    fmt::print("  {:<22} {:>10.6g} {:<16} {:g} to {:g}; {}\n", p.name, p.typical, p.unit, p.lowest, p.highest,
               p.meaning);
  }
  fmt::print("\nIn a scenario:\n\n  [[effect]]\n  id = \"{}\"\n", d.id);
  for (const auto& p : d.parameters) fmt::print("  {} = {}  # {}\n", p.name, p.typical, p.unit);
}

void print_list() {
  for (const auto& [id, entry] : physics::catalogue()) {
    fmt::print("{:<29} {:<34} {}\n", id, fmt::format("{}", fmt::join(entry.description.channels, " ")),
               entry.description.equation);
  }
  fmt::print("\n{} effects; hemi effects ID explains one\n", physics::catalogue().size());
}

int effects(const EffectsOptions& options) {
  if (!options.id.empty()) {
    const EffectDescription& description = scenario::find_effect(options.id, {}).description;
    if (options.json)
      fmt::print("{}\n", recording::json_text(as_json(description), 2));
    else
      print_one(description);
    return exit_good;
  }
  if (!options.json) {
    print_list();
    return exit_good;
  }
  recording::Json all = recording::Json::array();
  for (const auto& [id, entry] : physics::catalogue()) all.push_back(as_json(entry.description));
  fmt::print("{}\n", recording::json_text(all, 2));
  return exit_good;
}

}  // namespace

void add_effects(CLI::App& app, Job& job) {
  auto options = std::make_shared<EffectsOptions>();
  auto* command = app.add_subcommand("effects", "Catalogue of the physics that instrument models leave out");
  command->add_option("id", options->id, "effect to explain; none: list of all");
  command->add_flag("--json", options->json, "as JSON");
  command->footer("Example: hemi effects thermal_hysteresis");
  command->callback([options, &job] { job = [options] { return effects(*options); }; });
}

}  // namespace hemi::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/report/diagnosis_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/recording/channels.hpp"
#include "cli/report/ticks.hpp"

namespace hemi::report {
namespace {

using recording::Json;
using Units = std::vector<std::pair<std::string, std::string>>;

std::string unit_of(const std::string& channel, const Units& units) {
  for (const auto& [name, unit] : units)
    if (name == channel) return unit;
  const auto* known = recording::find_channel(channel);
  return known == nullptr ? std::string() : std::string(known->unit);
}

std::string ids_of(const Json& list) {
  std::vector<std::string> names;
  if (list.is_array())
    for (const Json& entry : list) {
      const std::string name = in_words(text_of(member(entry, "id")));
      if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  return listed(names);
}

/// The channel that gains most on rows left out (on those fitted where none were): what a reader asks first.
struct Headline {
  std::string channel, rows;
  Json figures;
};
std::optional<Headline> headline(const Json& diagnosis) {
  const Json& improvement = member(diagnosis, "improvement");
  if (!improvement.is_object()) return std::nullopt;
  std::optional<Headline> best;
  double best_ratio = 0.0;
  for (const auto& [channel, parts] : improvement.items()) {
    for (const auto& [key, words] :
         {std::pair{"heldout", "on rows left out of the fit"}, std::pair{"train", "on the rows fitted"}}) {
      const Json& part = member(parts, key);
      const auto before = number_of(member(part, "before_rms")), after = number_of(member(part, "after_rms"));
      if (!before || !after) continue;
      const double ratio = *after > 0.0 ? *before / *after : *before;
      if (!best || ratio > best_ratio) {
        best = {channel, words, part};
        best_ratio = ratio;
      }
      break;
    }
  }
  return best;
}

std::string fall(const Json& diagnosis, const Units& units) {
  const auto top = headline(diagnosis);
  if (!top) return {};
  const std::string unit = unit_of(top->channel, units);
  std::string text = fmt::format("the residual of {} falls {} from {} to {} {} rms", top->channel, top->rows,
                                 cell(top->figures["before_rms"]), cell(top->figures["after_rms"]), unit);
  if (const auto floor = number_of(member(top->figures, "floor_rms")))
    text += fmt::format(" (floor {})", nice_number(*floor, 4));
  return text;
}

std::string where(const Json& diagnosis) {
  std::vector<std::string> channels;
  if (const Json& located = member(diagnosis, "located"); located.is_array())
    for (const Json& entry : located) {
      const std::string channel = text_of(member(entry, "channel"));
      if (!channel.empty() && std::ranges::find(channels, channel) == channels.end())
        channels.push_back(channel);
    }
  return channels.empty() ? std::string() : " in " + listed(channels);
}

}  // namespace

const Json& member(const Json& object, const char* key) {
  static const Json null;
  if (!object.is_object()) return null;
  const auto found = object.find(key);
  return found == object.end() ? null : *found;
}

std::string text_of(const Json& value) {
  if (value.is_null()) return {};
  return value.is_string() ? value.get<std::string>() : recording::json_text(value);
}

std::optional<double> number_of(const Json& value) {
  if (!value.is_number()) return std::nullopt;
  return value.get<double>();
}

std::string cell(const Json& value) {
  const auto number = number_of(value);
  return number ? nice_number(*number, 4) : "–";
}

std::string range_of(const Json& value, const std::string& unit) {
  if (!value.is_array() || value.size() != 2 || !value[0].is_number() || !value[1].is_number()) return {};
  std::string text = cell(value[0]) + " to " + cell(value[1]);
  if (!unit.empty() && unit != "1") text += " " + unit;
  return text;
}

std::string in_words(std::string id) {
  std::ranges::replace(id, '_', ' ');
  return id;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

Verdict verdict_of(const Json& diagnosis, const Units& units) {
  const std::string verdict = text_of(member(diagnosis, "verdict"));
  const std::string gain = fall(diagnosis, units);
  const std::string names = ids_of(member(diagnosis, "effects"));
  if (verdict == "consistent")
    return {"The model tells all of this recording that the recording can show.", Tone::kGood};
  if (verdict == "recalibrate") {
    return {"The model's form is right, but its parameters have moved" +
                (gain.empty() ? std::string(".") : ": when they are refitted, " + gain + "."),
            Tone::kAttention};
  }
  if (verdict == "named") {
    return {fmt::format("The model leaves out {}{}.", names.empty() ? "an effect" : names,
                        gain.empty() ? "" : ": with it " + gain),
            Tone::kAttention};
  }
  if (verdict == "ambiguous") {
    const std::string rivals = ids_of(member(diagnosis, "alternatives"));
    return {fmt::format("Something real is left out{}, but this recording cannot separate {}.",
                        where(diagnosis), rivals.empty() ? "the candidates" : rivals),
            Tone::kAttention};
  }
  if (verdict == "unknown")
    return {fmt::format("Something real is left out{} that no effect of the catalogue explains.",
                        where(diagnosis)),
            Tone::kAttention};
  return {"The diagnosis gives no verdict.", Tone::kNeutral};
}

Table proof_table(const Json& diagnosis, const Units& units) {
  Table table{"Residual, rms",
              {"channel", "rows", "before", "after", "floor", "gain, 95 % interval", "unit"},
              {},
              {}};
  const Json& improvement = member(diagnosis, "improvement");
  if (!improvement.is_object()) return table;
  for (const auto& [channel, parts] : improvement.items()) {
    if (!parts.is_object()) continue;
    for (const auto& [key, part] : parts.items()) {
      if (!number_of(member(part, "before_rms"))) continue;
      const std::string rows = key == "train" ? "fitted" : key == "heldout" ? "left out" : in_words(key);
      const std::string gain = range_of(member(part, "gain_ci95"));
      table.rows.push_back({channel, rows, cell(member(part, "before_rms")), cell(member(part, "after_rms")),
                            cell(member(part, "floor_rms")), gain.empty() ? "–" : gain,
                            unit_of(channel, units)});
    }
  }
  return table;
}

Table located_table(const Json& diagnosis, const std::string& time_unit) {
  Table table{"", {"channel", "share of the misfit", "when", "where", "band", "block"}, {}, {}};
  const Json& located = member(diagnosis, "located");
  if (!located.is_array()) return table;
  for (const Json& entry : located) {
    std::string times;
    if (const Json& list = member(entry, "time_s"); list.is_array()) {
      constexpr std::size_t shown = 4;
      for (std::size_t i = 0; i < std::min(shown, list.size()); ++i)
        times += (i > 0 ? "; " : "") + range_of(list[i], time_unit);
      if (list.size() > shown) times += fmt::format("; {} more", list.size() - shown);
    }
    const Json& region = member(entry, "region");
    std::string place = text_of(member(region, "variable"));
    if (const std::string range = range_of(member(region, "range")); !range.empty()) place += " " + range;
    if (const std::string when = text_of(member(region, "when")); !when.empty()) place += ", " + when;
    const auto share = number_of(member(entry, "share_of_misfit"));
    table.rows.push_back({text_of(member(entry, "channel")),
                          share ? fmt::format("{:.1f} %", 100.0 * *share) : "–", times, place,
                          range_of(member(entry, "band_hz"), "Hz"), text_of(member(entry, "stage"))});
  }
  return table;
}

Table parameter_table(const Json& effect) {
  Table table{"", {"parameter", "value", "95 % interval", "unit"}, {}, {}};
  const Json& parameters = member(effect, "parameters");
  if (!parameters.is_object()) return table;
  for (const auto& [name, entry] : parameters.items()) {
    const std::string interval = range_of(member(entry, "ci95"));
    table.rows.push_back({name, cell(member(entry, "value")), interval.empty() ? "–" : interval,
                          text_of(member(entry, "unit"))});
  }
  return table;
}

Table limits_table(const Json& diagnosis) {
  Table table{"Smallest that this recording would have shown",
              {"effect", "parameter", "smallest", "unit", "below it"},
              {},
              {}};
  const Json& limits = member(diagnosis, "detection_limits");
  if (!limits.is_array()) return table;
  for (const Json& entry : limits) {
    const Json& smallest = member(entry, "smallest_detectable");
    if (!smallest.is_object() || smallest.empty()) {
      table.rows.push_back({in_words(text_of(member(entry, "id"))), "", "–", "",
                            text_of(member(entry, "present_below_limit"))});
      continue;
    }
    for (const auto& [name, value] : smallest.items())
      table.rows.push_back({in_words(text_of(member(entry, "id"))), name, cell(member(value, "value")),
                            text_of(member(value, "unit")), text_of(member(entry, "present_below_limit"))});
  }
  return table;
}

Table alternatives_table(const Json& diagnosis) {
  Table table{"", {"candidate", "score gap", "why it is not separated", "what would separate it"}, {}, {}};
  const Json& list = member(diagnosis, "alternatives");
  if (!list.is_array()) return table;
  for (const Json& entry : list) {
    std::string name = in_words(text_of(member(entry, "id")));
    if (const std::string form = text_of(member(entry, "form")); !form.empty()) name += " (" + form + ")";
    std::string experiment = text_of(member(entry, "separating_experiment"));
    if (const std::string words = text_of(member(entry, "experiment_in_words")); !words.empty())
      experiment += ": " + words;
    table.rows.push_back(
        {name, cell(member(entry, "score_gap")), text_of(member(entry, "why_not_separable")), experiment});
  }
  return table;
}

Table not_testable_table(const Json& diagnosis) {
  Table table{"What this recording cannot show at all", {"effect", "why"}, {}, {}};
  const Json& list = member(diagnosis, "not_testable");
  if (!list.is_array()) return table;
  for (const Json& entry : list)
    table.rows.push_back({in_words(text_of(member(entry, "id"))), text_of(member(entry, "why"))});
  return table;
}

std::vector<Table> evidence_tables(const Json& diagnosis) {
  std::vector<Table> tables;
  for (const auto& [key, title] : {std::pair{"tests", "Every test that was made"},
                                   std::pair{"orders", "Orders of f(T) that were compared"},
                                   std::pair{"families", "Forms that were compared"}}) {
    const Json& list = member(diagnosis, key);
    if (!list.is_array() || list.empty() || !list.front().is_object()) continue;
    Table table{title, {}, {}, {}};
    std::vector<std::string> keys;
    for (const auto& [name, value] : list.front().items()) {
      keys.push_back(name);
      table.columns.push_back(in_words(name));
    }
    for (const Json& entry : list) {
      std::vector<std::string> cells;
      for (const std::string& name : keys) {
        const Json& value = member(entry, name.c_str());
        const std::string range = range_of(value);
        cells.push_back(value.is_boolean()  ? (value.get<bool>() ? "yes" : "no")
                        : !range.empty()    ? range
                        : value.is_string() ? in_words(value.get<std::string>())
                                            : cell(value));
      }
      table.rows.push_back(std::move(cells));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace hemi::report

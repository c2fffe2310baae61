// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/recording/channels.hpp"
#include "cli/recording/error.hpp"

namespace hemi::scenario {
namespace {

using recording::in_quotes;

// Quantities of scenarios that recordings do not have.
struct Spelling {
  std::string_view text;
  std::string_view base;
  double scale;
};
constexpr Spelling kSpellings[] = {{"d", "s", 86400.0},           {"hours", "s", 3600.0},
                                   {"deg", "deg", 1.0},           {"°", "deg", 1.0},
                                   {"degC/min", "degC/min", 1.0}, {"degC/h", "degC/min", 1.0 / 60.0},
                                   {"deg/s^2", "deg/s^2", 1.0},   {"ppm", "1", 1e-6}};

std::string units_of(std::string_view unit) {
  if (unit == "s") return "s, ms, min, h or d";
  if (unit == "deg/h") return "deg/h or deg/s";
  if (unit == "V") return "V or mV";
  if (unit == "Hz") return "Hz, mHz or kHz";
  if (unit == "1") return "no unit, % or ppm";
  return std::string(unit);
}

std::optional<recording::Conversion> conversion(std::string_view from, std::string_view to) {
  if (from == to) return recording::Conversion{};
  for (const Spelling& spelling : kSpellings) {
    if (spelling.text == from && spelling.base == to) return recording::Conversion{spelling.scale, 0.0};
  }
  return recording::conversion(from, to);
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

double parse_quantity(std::string_view text, const Quantity& quantity, const Where& where) {
  std::string_view rest = trimmed(text);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  double number = 0.0;
  const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (code != std::errc{}) {
    refuse(where, fmt::format("{} is no number", in_quotes(text)),
           fmt::format("write a number in {}, or text such as \"5 {}\"", quantity.unit, quantity.unit));
  }
  rest = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (rest.empty()) return number;
  const auto factor = conversion(rest, quantity.unit);
  if (!factor) {
    refuse(where, fmt::format("unit {} where {} is expected", in_quotes(rest), quantity.unit),
           fmt::format("use {}", units_of(quantity.unit)));
  }
  return number * factor->scale + factor->offset;
}

// Optimal string alignment.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({replaced, d[i - 1][j] + 1, d[i][j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

void refuse(const Where& where, std::string_view problem, std::string_view remedy) {
  throw recording::InputError({.path = where.path, .line = where.line, .channel = where.name}, problem,
                              remedy);
}

double read_quantity(const Value& value, const Quantity& quantity, const Where& where) {
  double number = 0.0;
  if (const auto* plain = std::get_if<double>(&value.content)) {
    number = *plain;
  } else if (const auto* text = std::get_if<std::string>(&value.content)) {
    number = parse_quantity(*text, quantity, where);
  } else {
    refuse(where, fmt::format("expected a number, found {}", kind_of(value)),
           fmt::format("write a number in {}, or text with its unit", quantity.unit));
  }
  if (number >= quantity.lowest && number <= quantity.highest) return number;
  refuse(where,
         fmt::format("{:g} {} is outside {:g} to {:g} {}", number, quantity.unit, quantity.lowest,
                     quantity.highest, quantity.unit),
         "correct it");
}

std::string nearest_name(std::string_view name, std::span<const std::string_view> known) {
  // A key of a megabyte must not cost a megabyte times the list.
  const std::string_view head = name.substr(0, 64);
  std::string_view best;
  std::size_t fewest = std::max<std::size_t>(1, head.size() / 2) + 1;
  for (const std::string_view candidate : known) {
    const bool begins = head.size() > 2 && candidate.starts_with(head);
    const std::size_t needed = begins ? 1 : edits(head, candidate);
    if (needed >= fewest) continue;
    fewest = needed;
    best = candidate;
  }
  return std::string(best);
}

Where Section::where(std::string_view key) const {
  const Value* value = find(key);
  const std::string name = where_.name.empty() ? std::string(key) : fmt::format("{}.{}", where_.name, key);
  return {where_.path, name, value != nullptr ? value->line : where_.line};
}

void Section::allow(std::span<const std::string_view> known) const {
  for (const Entry& entry : *table_) {
    if (std::ranges::find(known, entry.key) != known.end()) continue;
    const std::string nearest = nearest_name(entry.key, known);
    const std::string list = fmt::format("known here: {}", fmt::join(known, ", "));
    scenario::refuse({where_.path, where_.name, entry.value.line},
                     fmt::format("unknown key {}", in_quotes(entry.key)),
                     nearest.empty() ? list : fmt::format("did you mean '{}'? {}", nearest, list));
  }
}

const Value* Section::find(std::string_view key) const {
  const auto found = std::ranges::find(*table_, key, &Entry::key);
  return found == table_->end() ? nullptr : &found->value;
}

std::string_view Section::one_of(std::initializer_list<std::string_view> keys) const {
  std::string_view first;
  for (const std::string_view key : keys) {
    if (!has(key)) continue;
    if (!first.empty()) refuse(key, fmt::format("stands beside {}", first), "keep one of the two");
    first = key;
  }
  return first;
}

double Section::quantity(std::string_view key, const Quantity& quantity,
                         std::optional<double> fallback) const {
  if (const Value* value = find(key)) return read_quantity(*value, quantity, where(key));
  if (!fallback) refuse(key, "is missing", fmt::format("add it, in {}", quantity.unit));
  return *fallback;
}

std::vector<double> Section::quantities(std::string_view key, const Quantity& quantity) const {
  std::vector<double> numbers;
  for (const Value& item : list(key))
    numbers.push_back(read_quantity(item, quantity, {where_.path, where(key).name, item.line}));
  if (numbers.empty()) refuse(key, "the list is empty", "give at least one value");
  return numbers;
}

std::string Section::text(std::string_view key, std::string_view fallback) const {
  const Value* value = find(key);
  if (value == nullptr) return std::string(fallback);
  if (const auto* text = std::get_if<std::string>(&value->content)) return *text;
  refuse(key, fmt::format("expected text, found {}", kind_of(*value)), "put it into quotes");
}

std::string Section::choice(std::string_view key, std::initializer_list<std::string_view> choices,
                            std::string_view fallback) const {
  const std::string chosen = text(key, fallback);
  if (std::ranges::find(choices, chosen) != choices.end()) return chosen;
  const std::string nearest = nearest_name(chosen, std::span(choices.begin(), choices.size()));
  refuse(key, fmt::format("no such choice as {}", in_quotes(chosen)),
         fmt::format("{}use one of {}", nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest),
                     fmt::join(choices, ", ")));
}

bool Section::flag(std::string_view key, bool fallback) const {
  const Value* value = find(key);
  if (value == nullptr) return fallback;
  if (const bool* flag = std::get_if<bool>(&value->content)) return *flag;
  refuse(key, fmt::format("expected true or false, found {}", kind_of(*value)), "write true or false");
}

const List& Section::list(std::string_view key) const {
  const Value* value = find(key);
  if (value == nullptr) refuse(key, "is missing", "add a list [...]");
  if (const auto* list = std::get_if<List>(&value->content)) return *list;
  refuse(key, fmt::format("expected a list, found {}", kind_of(*value)), "write [...]");
}

Section Section::section(std::string_view key) const {
  static const Table empty;
  const Value* value = find(key);
  if (value == nullptr) return {empty, where(key)};
  if (const auto* table = std::get_if<Table>(&value->content)) return {*table, where(key)};
  refuse(key, fmt::format("expected a table, found {}", kind_of(*value)),
         "write [section] lines or {key = value}");
}

}  // namespace hemi::scenario

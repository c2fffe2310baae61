// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/value.hpp"

#include <toml++/toml.h>

#include <array>
#include <fstream>
#include <iterator>
#include <sstream>

#include "cli/recording/error.hpp"

namespace hemi::scenario {
namespace {

Value convert(const toml::node& node);

Value convert_table(const toml::table& table, std::size_t line) {
  Table entries;
  for (const auto& [key, node] : table) {
    Entry entry{std::string(key.str()), convert(node)};
    // A table made by a dotted key or by a header below it has no place of its own.
    if (entry.value.line == 0) entry.value.line = key.source().begin.line;
    entries.push_back(std::move(entry));
  }
  return {line, std::move(entries)};
}

Value convert(const toml::node& node) {
  const std::size_t line = node.source().begin.line;
  if (const auto* table = node.as_table()) return convert_table(*table, line);
  if (const auto* array = node.as_array()) {
    List list;
    for (const toml::node& item : *array) list.push_back(convert(item));
    return {line, std::move(list)};
  }
  if (const auto* text = node.as_string()) return {line, text->get()};
  if (const auto* flag = node.as_boolean()) return {line, flag->get()};
  if (const auto* integer = node.as_integer()) return {line, static_cast<double>(integer->get())};
  if (const auto* number = node.as_floating_point()) return {line, number->get()};
  std::ostringstream text;
  if (const auto* date = node.as_date()) text << *date;
  if (const auto* time = node.as_time()) text << *time;
  if (const auto* both = node.as_date_time()) text << *both;
  return {line, text.str()};
}

}  // namespace

Value read_toml(const std::string& path) {
  recording::require_readable(path);
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  try {
    return convert_table(toml::parse(text, path), 1);
  } catch (const toml::parse_error& error) {
    throw recording::InputError({.path = path, .line = error.source().begin.line},
                                "not valid TOML: " + std::string(error.description()),
                                "check this line and the one before for a missing quote, bracket or comma");
  }
}

std::string_view kind_of(const Value& value) {
  constexpr std::array<std::string_view, 5> names = {"true or false", "a number", "text", "a list",
                                                     "a table"};
  return names[value.content.index()];
}

}  // namespace hemi::scenario

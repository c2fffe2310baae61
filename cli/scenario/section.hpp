// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/scenario/value.hpp"

namespace hemi::scenario {

/// A quantity: the unit of plain numbers and the values that are possible, ends included.
struct Quantity {
  std::string_view unit;  ///< as in recording::conversion: s, degC, deg/h, g, V, Hz, 1, ...
  double lowest;
  double highest;
};

/// Where a value stands: for messages.
struct Where {
  std::string path;
  std::string name;  ///< "chamber.profile"
  std::size_t line;
};

/// InputError `file:line: name: problem; remedy`.
[[noreturn]] void refuse(const Where& where, std::string_view problem, std::string_view remedy);

/// A number in the quantity's unit, or text with a unit of its own ("5 h", "-20 degC"). InputError for
/// anything else, for a unit of another quantity and for values outside the range.
double read_quantity(const Value& value, const Quantity& quantity, const Where& where);

/// The name in `known` that needs the fewest edits (insert, delete, replace, swap neighbours) to become
/// `name`; empty where that takes more than half of its letters. A beginning of a name counts as one edit.
std::string nearest_name(std::string_view name, std::span<const std::string_view> known);

/// One table of a scenario. Every getter checks; keys that no getter knows are refused by allow().
class Section {
 public:
  Section(const Table& table, Where where) : table_(&table), where_(std::move(where)) {}

  const Where& where() const { return where_; }
  /// Of a key; the section's own line where the key is absent.
  Where where(std::string_view key) const;

  /// InputError for the first key that is not in `known`, with the nearest one and the list.
  void allow(std::span<const std::string_view> known) const;
  void allow(std::initializer_list<std::string_view> known) const {
    allow(std::span<const std::string_view>(known.begin(), known.size()));
  }

  const Value* find(std::string_view key) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// Which of these keys is there: at most one may be. Empty for none.
  std::string_view one_of(std::initializer_list<std::string_view> keys) const;

  double quantity(std::string_view key, const Quantity& quantity, std::optional<double> fallback = {}) const;
  std::vector<double> quantities(std::string_view key, const Quantity& quantity) const;
  std::string text(std::string_view key, std::string_view fallback) const;
  /// Text that is one of the choices.
  std::string choice(std::string_view key, std::initializer_list<std::string_view> choices,
                     std::string_view fallback) const;
  bool flag(std::string_view key, bool fallback) const;
  const List& list(std::string_view key) const;
  /// The table under a key; an empty one where the key is absent.
  Section section(std::string_view key) const;

  [[noreturn]] void refuse(std::string_view key, std::string_view problem, std::string_view remedy) const {
    scenario::refuse(where(key), problem, remedy);
  }

 private:
  const Table* table_;
  Where where_;
};

}  // namespace hemi::scenario

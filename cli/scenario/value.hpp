// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace hemi::scenario {

struct Value;
struct Entry;
using List = std::vector<Value>;
using Table = std::vector<Entry>;

/// A TOML value with the line on which it begins. Integers are doubles, dates and times their text.
struct Value {
  std::size_t line = 0;
  std::variant<bool, double, std::string, List, Table> content{};
};

struct Entry {
  std::string key;
  Value value;
};

/// The whole file as a table. InputError (file, line) for a file that cannot be read and for text that is no
/// TOML 1.0.
Value read_toml(const std::string& path);

/// "a number", "a list", ...; for messages.
std::string_view kind_of(const Value& value);

}  // namespace hemi::scenario

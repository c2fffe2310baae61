// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/recording/error.hpp"

namespace hemi::recording {

/// One numeric cell; problem and remedy are nullptr where it is well.
struct CellResult {
  double value;
  const char* problem = nullptr;
  const char* remedy = nullptr;
};

/// A decimal number, rounded to the nearest double; empty and `nan` give NaN.
CellResult parse_cell(std::string_view cell);

/// Names of a header line, with RFC 4180 quotes undone. InputError for binary bytes, other separators,
/// numbers, empty or doubled names.
std::vector<std::string> parse_header(std::string_view line, const Place& place);

/// Nothing but blanks and tabs.
bool is_blank(std::string_view line);

}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/csv_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace hemi::recording {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// The rare forms that from_chars alone does not settle.
CellResult parse_unusual(std::string_view text) {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  constexpr CellResult infinite{missing, "is infinite", "leave the cell empty where the value is missing"};
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    text = trimmed(text.substr(1, text.size() - 2));
  }
  std::string_view digits = text;
  if (!digits.empty() && (digits.front() == '+' || digits.front() == '-')) digits.remove_prefix(1);
  if (text.empty()) return {missing};
  const bool number =
      !digits.empty() && (digits.front() == '.' || (digits.front() >= '0' && digits.front() <= '9'));
  double value = 0.0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size() && code != std::errc::invalid_argument;
  if (whole && std::isnan(value)) return {missing};
  if (whole && std::isinf(value)) return infinite;
  if (!whole || !number) {
    return {missing, "is not a number",
            "write a decimal number, or leave the cell empty where it is missing"};
  }
  // Out of range in either direction: strtod tells infinity from a number too small.
  if (code == std::errc::result_out_of_range) value = std::strtod(std::string(digits).c_str(), nullptr);
  if (std::isinf(value)) return infinite;
  return {text.front() == '-' ? -value : value};
}

// Well-formed sequences of UTF-8; overlong forms pass, for nothing here depends on them.
bool is_utf8(std::string_view text) {
  int following = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continuation = (byte & 0xC0) == 0x80;
    if (continuation != (following > 0) || byte >= 0xF8) return false;
    if (continuation) {
      --following;
    } else {
      following = byte < 0x80 ? 0 : byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
    }
  }
  return following == 0;
}

void check_bytes(std::string_view line, const Place& place) {
  if (line.starts_with("\xFF\xFE") || line.starts_with("\xFE\xFF")) {
    throw InputError(place, "the text is UTF-16", "save it as UTF-8");
  }
  const bool binary = std::ranges::any_of(line, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t') || byte == 0x7f;
  });
  if (binary) {
    throw InputError(
        place, "binary bytes where a line of channel names should stand",
        "give a comma-separated text file, or name HDF5 and sound files .h5, .mat, .wav or .flac");
  }
  if (!is_utf8(line)) {
    throw InputError(place, "the header is not UTF-8 (a degree sign from another encoding?)",
                     "save it as UTF-8");
  }
}

std::vector<std::string> split_header(std::string_view line, const Place& place) {
  std::vector<std::string> names(1);
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (inside && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      names.back() += '"';
      ++i;
    } else if (c == '"' && (inside || trimmed(names.back()).empty())) {
      inside = !inside;
    } else if (c == ',' && !inside) {
      names.emplace_back();
    } else {
      names.back() += c;
    }
  }
  if (inside) throw InputError(place, "a quote in the header is not closed", "close it on the same line");
  return names;
}

}  // namespace

CellResult parse_cell(std::string_view cell) {
  cell = trimmed(cell);
  if (cell.empty()) return {std::numeric_limits<double>::quiet_NaN()};
  double value = 0.0;
  const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (code == std::errc() && end == cell.data() + cell.size() && std::isfinite(value)) return {value};
  return parse_unusual(cell);
}

bool is_blank(std::string_view line) {
  return trimmed(line).empty();
}

std::vector<std::string> parse_header(std::string_view line, const Place& place) {
  check_bytes(line, place);
  std::vector<std::string> names = split_header(line, place);
  if (names.size() == 1 && names[0].find_first_of(";\t") != std::string::npos) {
    throw InputError(place, "the columns are not separated by commas",
                     "write commas between columns and points in numbers");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i] = std::string(trimmed(names[i]));
    if (names[i].empty()) {
      throw InputError(place, fmt::format("column {} has no name", i + 1), "name it in the header");
    }
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw InputError(place, "two columns are named " + in_quotes(names[i]), "rename one of them");
    }
  }
  const bool numbers =
      std::ranges::all_of(names, [](const std::string& name) { return parse_cell(name).problem == nullptr; });
  if (numbers) {
    throw InputError(place, "numbers where the channel names should stand",
                     "put a line of channel names first, without '#'");
  }
  return names;
}

}  // namespace hemi::recording

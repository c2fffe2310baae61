// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "cli/recording/error.hpp"

namespace hemi::recording {

Json read_json_object(const std::string& path) {
  require_readable(path);
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  try {
    Json document = Json::parse(text);
    if (document.is_object()) return document;
    throw InputError({.path = path, .line = 1}, "the file holds no JSON object", "start it with '{'");
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = static_cast<std::size_t>(std::count(text.begin(), end, '\n')) + 1;
    throw InputError({.path = path, .line = line}, "not valid JSON",
                     "check this line and the one before for a missing comma, quote or bracket");
  } catch (const Json::out_of_range&) {
    throw InputError({.path = path}, "a number is too large for a double", "correct it");
  }
}

std::string json_text(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

double number_or(const Json& object, const char* key, double fallback, const std::string& path,
                 const std::string& context) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return fallback;
  const std::string name = context.empty() ? key : context + "." + key;
  if (!found->is_number() || !std::isfinite(found->get<double>())) {
    throw InputError({.path = path, .channel = name},
                     "expected a number, found " + in_quotes(json_text(*found)), "correct it");
  }
  return found->get<double>();
}

std::string text_or_empty(const Json& object, const char* key, const std::string& path) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return {};
  if (!found->is_string()) {
    throw InputError({.path = path, .channel = key}, "expected text, found " + in_quotes(json_text(*found)),
                     "put it into quotes");
  }
  return found->get<std::string>();
}

}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace hemi::recording {

/// Keeps the order of keys, so that a file that is read and written again reads the same to people.
using Json = nlohmann::ordered_json;

/// The object in a JSON file; InputError with the line for anything that is no JSON object.
Json read_json_object(const std::string& path);

/// Text of a value, on one line or indented; bytes that are not UTF-8 become U+FFFD instead of an exception.
std::string json_text(const Json& value, int indent = -1);

/// object[key] as a finite number, or `fallback` where the key is absent; InputError names path and key.
double number_or(const Json& object, const char* key, double fallback, const std::string& path,
                 const std::string& context = "");

/// object[key] as text, or empty where the key is absent.
std::string text_or_empty(const Json& object, const char* key, const std::string& path);

}  // namespace hemi::recording

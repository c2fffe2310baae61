// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/stored_text.hpp"

namespace hemi::recording {
namespace {

// One code point as UTF-8.
void append_utf8(std::string& out, std::uint32_t code) {
  const auto byte = [&out](std::uint32_t value) { out += static_cast<char>(value); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0 | code >> 6);
    byte(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    byte(0xE0 | code >> 12);
    byte(0x80 | (code >> 6 & 0x3F));
    byte(0x80 | (code & 0x3F));
  } else {
    byte(0xF0 | code >> 18);
    byte(0x80 | (code >> 12 & 0x3F));
    byte(0x80 | (code >> 6 & 0x3F));
    byte(0x80 | (code & 0x3F));
  }
}

}  // namespace

Json text_value(const std::string& text) {
  const bool structured =
      text.starts_with('{') || text.starts_with('[') || text == "true" || text == "false" || text == "null";
  if (structured) {
    Json parsed = Json::parse(text, nullptr, false);
    if (!parsed.is_discarded()) return parsed;
  }
  return text;
}

std::string ascii_json(const Json& value) {
  constexpr bool kAscii = true;
  return value.dump(-1, ' ', kAscii, Json::error_handler_t::replace);
}

std::string utf8_of_utf16(std::span<const std::uint16_t> units) {
  std::string text;
  for (std::size_t i = 0; i < units.size(); ++i) {
    std::uint32_t code = units[i];
    const bool pair = (code & 0xFC00) == 0xD800 && i + 1 < units.size() && (units[i + 1] & 0xFC00) == 0xDC00;
    if (pair) code = 0x10000 + ((code & 0x3FF) << 10) + (units[++i] & 0x3FFU);
    append_utf8(text, code);
  }
  return text;
}

}  // namespace hemi::recording

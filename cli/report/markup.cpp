// SPDX-License-Identifier: Apache-2.0
#include "cli/report/markup.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

#include "cli/recording/json.hpp"

namespace hemi::report {

std::string escaped(std::string_view text) {
  // The JSON writer knows what UTF-8 is, and replaces what is not.
  const std::string valid =
      recording::Json::parse(recording::json_text(std::string(text))).get<std::string>();
  std::string out;
  out.reserve(valid.size());
  for (const char c : valid) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      case '\t':
      case '\n':
        out += c;
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
          out += "\uFFFD";
        else
          out += c;
    }
  }
  return out;
}

std::string base64(std::span<const double> values) {
  static_assert(std::endian::native == std::endian::little, "the page reads little-endian doubles");
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t bytes = values.size_bytes();
  const auto* data = reinterpret_cast<const unsigned char*>(values.data());
  std::string out;
  out.reserve((bytes + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes; i += 3) {
    const std::size_t n = bytes - i;
    const std::uint32_t three = (std::uint32_t{data[i]} << 16) |
                                (n > 1 ? std::uint32_t{data[i + 1]} << 8 : 0U) |
                                (n > 2 ? std::uint32_t{data[i + 2]} : 0U);
    out += digits[three >> 18];
    out += digits[three >> 12 & 63];
    out += n > 1 ? digits[three >> 6 & 63] : '=';
    out += n > 2 ? digits[three & 63] : '=';
  }
  return out;
}

std::string with_unit(std::string_view label, std::string_view unit) {
  std::string text(label);
  if (!unit.empty() && unit != "1") text += " [" + std::string(unit) + "]";
  return text;
}

}  // namespace hemi::report

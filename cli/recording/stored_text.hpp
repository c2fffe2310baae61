// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "cli/recording/json.hpp"

namespace hemi::recording {

/// Value that a text in an HDF5 attribute or MATLAB variable stands for: text that is a JSON object, array,
/// truth value or null comes back as such, for neither has nested attributes; else the text itself.
Json text_value(const std::string& text);

/// JSON text of ASCII alone (other characters escaped), which no reader of MATLAB files takes for another
/// encoding.
std::string ascii_json(const Json& value);

/// UTF-16 units, as MATLAB keeps text, to UTF-8; a lone surrogate becomes the three bytes of its number.
std::string utf8_of_utf16(std::span<const std::uint16_t> units);

}  // namespace hemi::recording

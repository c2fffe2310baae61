// SPDX-License-Identifier: Apache-2.0
// Text into HTML, SVG and scripts without becoming markup.
#ifndef HEMI_CLI_REPORT_MARKUP_HPP
#define HEMI_CLI_REPORT_MARKUP_HPP

#include <span>
#include <string>
#include <string_view>

namespace hemi::report {

/// & < > " ' as entities; bytes that are not UTF-8 and control bytes but tab and line feed become U+FFFD.
std::string escaped(std::string_view text);

/// The bytes of the doubles, little-endian, in base 64.
std::string base64(std::span<const double> values);

/// "label [unit]"; no bracket for a plain number.
std::string with_unit(std::string_view label, std::string_view unit);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_MARKUP_HPP

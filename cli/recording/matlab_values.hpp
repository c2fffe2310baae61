// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/recording/json.hpp"
#include "cli/recording/matlab_handle.hpp"

namespace hemi::recording {

/// Why a variable cannot be a channel ("struct", "cell array", "matrix", ...); empty for a vector of real
/// numbers.
std::string unusable_kind(const matvar_t& variable);

/// Bytes of values that a variable claims to have, fields and cells included.
double claimed_bytes(const matvar_t& variable);

/// Product of its sizes.
double claimed_elements(const matvar_t& variable);

/// Values of a vector whose data has been read; nullopt where the library left it without data.
std::optional<std::vector<double>> vector_values(const matvar_t& variable);

/// Text of a variable of class char as UTF-8.
std::string char_text(const matvar_t& variable);

/// Struct to object, text to text (or what the text stands for), numbers to numbers or lists; null for
/// anything else.
Json matlab_value(const matvar_t& variable, int depth = 0);

}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace hemi::recording {

enum class MatlabVersion { k5, k73 };  // v7 is v5 with compressed variables

/// By the header. InputError: a version that is not read (v4, newer ones), no MATLAB file, cut off.
MatlabVersion matlab_version(const std::string& path);

/// Number of variables of a v5 or v7 file, by the lengths that stand before each. InputError where one of
/// them goes beyond the end of the file.
std::size_t count_matlab_variables(const std::string& path);

/// A kind of variable, as matlab_remedy knows it.
inline constexpr const char* kMatlabObject = "table, string or other object";

/// How to get vectors out of what MATLAB keeps in tables, structs and objects.
std::string matlab_remedy(const std::string& kind, const std::string& variable);

}  // namespace hemi::recording

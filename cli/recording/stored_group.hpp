// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "cli/recording/json.hpp"

namespace hemi::recording {

/// Name of the group (HDF5) or struct (MATLAB) that holds a raw capture.
inline constexpr const char* kRawGroup = "raw";

/// MATLAB variable that holds the sidecar's keys: JSON text, or a struct.
inline constexpr const char* kSidecarVariable = "sidecar";

/// One vector of an HDF5 or MATLAB file.
struct StoredArray {
  std::string name{};
  std::string unit{};  ///< HDF5 attribute `unit`, empty where there is none
  std::vector<double> values{};
};

/// Vectors of one group of an HDF5 or MATLAB file, not yet resolved to channels.
struct StoredGroup {
  std::string group{};  ///< "" top level, or "raw"
  std::vector<StoredArray> arrays{};
  Json file_attributes = Json::object();   ///< of the file, plus single values and texts stored as arrays
  Json group_attributes = Json::object();  ///< of the group where it is not the top level
  std::vector<std::string> notes{};
};

enum class ArrayUse { kIgnore, kAttribute, kChannel };

/// What to do with the array of that name. kAttribute is for single numbers: MATLAB stores them as variables,
/// and cannot easily set attributes of a file.
using ArrayChooser = std::function<ArrayUse(const std::string& name)>;

/// An array to write: doubles, or integers kept as 32-bit integers.
struct OutputArray {
  std::string name{};
  std::string unit{};
  std::variant<const std::vector<double>*, const std::vector<std::int32_t>*> values;
};

struct OutputGroup {
  Json file_attributes = Json::object();
  std::string group{};  ///< that holds the arrays: "" top level, or "raw"
  Json group_attributes = Json::object();
  std::vector<OutputArray> arrays{};
};

}  // namespace hemi::recording

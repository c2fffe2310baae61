// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "cli/recording/table.hpp"

namespace hemi::recording {

/// Datasets of one group of an HDF5 file (MATLAB's v7.3 .mat included), not yet resolved to channels.
struct Hdf5Dataset {
  std::string name{};
  std::string unit{};  ///< attribute `unit`, empty where there is none
  std::vector<double> values{};
};

struct Hdf5Group {
  std::string group{};  ///< "" top level, or "raw"
  std::vector<Hdf5Dataset> datasets{};
  Json file_attributes = Json::object();   ///< of the file, plus single values and texts stored as datasets
  Json group_attributes = Json::object();  ///< of the group where it is not the top level
  std::vector<std::string> notes{};
};

enum class DatasetUse { kIgnore, kAttribute, kChannel };

/// What to do with the dataset of that name. kAttribute is for single numbers: MATLAB can store them as
/// variables, and cannot easily set attributes of a file.
using DatasetChooser = std::function<DatasetUse(const std::string& name)>;

/// One-dimensional (or n x 1) integer and floating-point datasets of the group `raw`, where `raw` is true and
/// the group is there, else of the top level. InputError: not HDF5, damaged, other types or shapes of wanted
/// datasets.
Hdf5Group read_hdf5(const std::string& path, bool raw, const DatasetChooser& chooser);

/// Names of the numeric datasets: top level as they are, those of the group `raw` as "raw/NAME".
std::vector<std::string> hdf5_dataset_names(const std::string& path);

/// A dataset to write: doubles, or integers kept as 32-bit integers.
struct Hdf5Output {
  std::string name{};
  std::string unit{};
  std::variant<const std::vector<double>*, const std::vector<std::int32_t>*> values;
};

struct Hdf5Content {
  Json file_attributes = Json::object();
  std::string group{};  ///< that holds the datasets: "" top level, or "raw"
  Json group_attributes = Json::object();
  std::vector<Hdf5Output> datasets{};
};

/// The file appears whole or not at all; OutputError otherwise. Equal content gives equal bytes.
void write_hdf5_file(const std::string& path, const Hdf5Content& content);

}  // namespace hemi::recording

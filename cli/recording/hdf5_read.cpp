// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>

#include "cli/recording/hdf5_attributes.hpp"
#include "cli/recording/hdf5_file.hpp"
#include "cli/recording/interrupt.hpp"

namespace hemi::recording {
namespace {

constexpr const char* kRawGroup = "raw";

Hdf5Handle open_file(const std::string& path) {
  require_readable(path);
  const htri_t is_hdf5 = H5Fis_hdf5(path.c_str());
  if (is_hdf5 <= 0) {
    char head[6] = {};
    std::ifstream(path, std::ios::binary).read(head, sizeof head);
    const bool old_matlab = std::string_view(head, sizeof head) == "MATLAB";
    throw InputError({.path = path}, old_matlab ? "a MATLAB file older than v7.3" : "not an HDF5 file",
                     old_matlab ? "save it with save(..., '-v7.3')"
                                : "check that the file is complete and its name ends as its kind demands");
  }
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.ok()) {
    throw InputError({.path = path}, "the HDF5 file is damaged or cut off", "copy or record it again");
  }
  return file;
}

extern "C" herr_t collect_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

// In the order of their creation where the file has kept it.
std::vector<std::string> member_names(hid_t group) {
  std::vector<std::string> names;
  if (H5Literate(group, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect_name, &names) < 0) {
    names.clear();
    H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_name, &names);
  }
  return names;
}

std::optional<H5I_type_t> member_type(hid_t group, const std::string& name) {
  const Hdf5Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
  if (!object.ok()) return std::nullopt;
  return H5Iget_type(object);
}

bool has_group(hid_t file, const char* name) {
  return H5Lexists(file, name, H5P_DEFAULT) > 0 && member_type(file, name) == H5I_GROUP;
}

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

// Number of values of a vector (n, n x 1, 1 x n, scalar), nullopt for any other shape.
std::optional<std::size_t> vector_length(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0 || rank > 2) return std::nullopt;
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
  if (rank == 2 && sizes[0] != 1 && sizes[1] != 1) return std::nullopt;
  hsize_t length = 1;
  for (const hsize_t size : sizes) length *= size;
  return static_cast<std::size_t>(length);
}

std::vector<double> read_values(hid_t dataset, const Place& place) {
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  if (!is_number(type)) {
    throw InputError(place, "holds neither integers nor floating-point numbers",
                     "store numbers, or map it to null under \"columns\" in the sidecar");
  }
  const auto length = vector_length(space);
  if (!length) {
    throw InputError(place, "is not one-dimensional",
                     "store one dataset a channel, or map it to null under \"columns\" in the sidecar");
  }
  check_interrupt();
  if (!is_backed(dataset)) {
    throw InputError(place,
                     fmt::format("claims {} values, more than its bytes in the file can hold", *length),
                     "the file is damaged, or was never completed: record it again");
  }
  std::vector<double> values(*length);
  if (*length > 0 && H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    throw InputError(place, "cannot be read: damaged, cut off, or packed with a filter that is not installed",
                     "copy or record it again");
  }
  return values;
}

void read_member(hid_t parent, const std::string& path, const std::string& name,
                 const DatasetChooser& chooser, Hdf5Group& group) {
  const auto kind = member_type(parent, name);
  if (kind == H5I_GROUP && name != kRawGroup && !name.starts_with('#')) {
    group.notes.push_back(fmt::format("{}: group '{}' ignored", path, name));
  }
  if (kind != H5I_DATASET) return;
  const Hdf5Handle dataset(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Place place{.path = path, .channel = name};
  Json& attributes = group.group.empty() ? group.file_attributes : group.group_attributes;
  const DatasetUse use = chooser(name);
  if (is_matlab_text(dataset)) {
    attributes[name] = matlab_text(dataset);
  } else if (use == DatasetUse::kChannel) {
    const Json unit = read_attribute(dataset, "unit");
    group.datasets.push_back(
        {name, unit.is_string() ? unit.get<std::string>() : "", read_values(dataset, place)});
  } else if (use == DatasetUse::kAttribute) {
    const std::vector<double> values = read_values(dataset, place);
    if (values.size() != 1) throw InputError(place, "is not a single number", "store one number");
    attributes[name] = values.front();
  }
}

}  // namespace

Hdf5Group read_hdf5(const std::string& path, bool raw, const DatasetChooser& chooser) {
  const Hdf5Silence silence;
  const Hdf5Handle file = open_file(path);
  Hdf5Group result;
  if (raw && has_group(file, kRawGroup)) result.group = kRawGroup;
  const Hdf5Handle parent(H5Gopen2(file, result.group.empty() ? "/" : kRawGroup, H5P_DEFAULT), H5Gclose);
  try {
    result.file_attributes = read_attributes(file);
    if (!result.group.empty()) result.group_attributes = read_attributes(parent);
    for (const std::string& name : member_names(parent)) read_member(parent, path, name, chooser, result);
  } catch (const std::bad_alloc&) {
    throw InputError({.path = path}, "claims more than fits into memory",
                     "the file is damaged: record it again");
  } catch (const std::length_error&) {
    throw InputError({.path = path}, "claims more than fits into memory",
                     "the file is damaged: record it again");
  }
  return result;
}

std::vector<std::string> hdf5_dataset_names(const std::string& path) {
  const Hdf5Silence silence;
  const Hdf5Handle file = open_file(path);
  std::vector<std::string> names;
  const auto collect = [&names](hid_t group, const std::string& prefix) {
    for (const std::string& name : member_names(group)) {
      if (member_type(group, name) != H5I_DATASET) continue;
      const Hdf5Handle dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
      if (!is_matlab_text(dataset)) names.push_back(prefix + name);
    }
  };
  collect(file, "");
  if (has_group(file, kRawGroup)) {
    const Hdf5Handle group(H5Gopen2(file, kRawGroup, H5P_DEFAULT), H5Gclose);
    collect(group, "raw/");
  }
  return names;
}

}  // namespace hemi::recording

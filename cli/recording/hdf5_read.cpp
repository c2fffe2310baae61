// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>

#include "cli/recording/error.hpp"
#include "cli/recording/hdf5_attributes.hpp"
#include "cli/recording/hdf5_file.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/matlab_version.hpp"
#include "cli/recording/stored_text.hpp"

namespace hemi::recording {
namespace {

Hdf5Handle open_file(const std::string& path) {
  require_readable(path);
  const htri_t is_hdf5 = H5Fis_hdf5(path.c_str());
  if (is_hdf5 <= 0) {
    char head[6] = {};
    std::ifstream(path, std::ios::binary).read(head, sizeof head);
    const bool old_matlab = std::string_view(head, sizeof head) == "MATLAB";
    throw InputError({.path = path}, old_matlab ? "a MATLAB file" : "not an HDF5 file",
                     old_matlab ? "let its name end in .mat"
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
  // An empty MATLAB array keeps its sizes where others keep values.
  if (read_attribute(dataset, "MATLAB_empty") == 1) return {};
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

// Classes of MATLAB variables that are plain arrays; tables and other objects keep references here.
bool is_matlab_object(hid_t object) {
  const Json kind = read_attribute(object, "MATLAB_class");
  if (!kind.is_string()) return false;
  const auto text = kind.get<std::string>();
  const bool plain = text == "double" || text == "single" || text == "logical" || text == "char" ||
                     text == "cell" || text.starts_with("int") || text.starts_with("uint");
  return !plain;
}

Json read_struct(hid_t group, int depth) {
  constexpr int kDeepest = 8;
  Json fields = Json::object();
  if (depth > kDeepest) return fields;
  for (const std::string& name : member_names(group)) {
    const auto kind = member_type(group, name);
    if (kind == H5I_GROUP) {
      const Hdf5Handle inner(H5Gopen2(group, name.c_str(), H5P_DEFAULT), H5Gclose);
      fields[name] = read_struct(inner, depth + 1);
    } else if (kind == H5I_DATASET) {
      const Hdf5Handle dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
      if (is_matlab_text(dataset)) {
        fields[name] = text_value(matlab_text(dataset));
        continue;
      }
      const std::vector<double> values = read_values(dataset, Place{.channel = name});
      fields[name] = values.size() == 1 ? Json(values.front()) : Json(values);
    }
  }
  return fields;
}

void read_group(hid_t parent, const Place& place, const ArrayChooser& chooser, Json& attributes,
                StoredGroup& result) {
  const std::string& name = place.channel;
  if (name == kRawGroup || name.starts_with('#')) return;
  const Hdf5Handle group(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose);
  const bool matlab_struct = group.ok() && read_attribute(group, "MATLAB_class") == "struct";
  if (matlab_struct && name == kSidecarVariable) {
    attributes[name] = read_struct(group, 0);
  } else if (matlab_struct && chooser(name) == ArrayUse::kChannel) {
    throw InputError(place, "is a struct", matlab_remedy("struct", name));
  } else if (!matlab_struct) {
    result.notes.push_back(fmt::format("{}: group '{}' ignored", place.path, name));
  }
}

void read_member(hid_t parent, const Place& place, const ArrayChooser& chooser, Json& attributes,
                 StoredGroup& result) {
  const std::string& name = place.channel;
  const auto kind = member_type(parent, name);
  if (kind == H5I_GROUP) read_group(parent, place, chooser, attributes, result);
  if (kind != H5I_DATASET) return;
  const Hdf5Handle dataset(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose);
  const ArrayUse use = chooser(name);
  if (is_matlab_text(dataset)) {
    attributes[name] = text_value(matlab_text(dataset));
  } else if (use != ArrayUse::kIgnore && is_matlab_object(dataset)) {
    throw InputError(place, std::string("is a ") + kMatlabObject, matlab_remedy(kMatlabObject, name));
  } else if (use == ArrayUse::kChannel) {
    const Json unit = read_attribute(dataset, "unit");
    result.arrays.push_back(
        {name, unit.is_string() ? unit.get<std::string>() : "", read_values(dataset, place)});
  } else if (use == ArrayUse::kAttribute) {
    const std::vector<double> values = read_values(dataset, place);
    if (values.size() != 1) throw InputError(place, "is not a single number", "store one number");
    attributes[name] = values.front();
  }
}

// Texts and metadata at the top level count for the group raw as well.
void read_members(hid_t file, const std::string& path, const ArrayChooser& chooser, StoredGroup& result) {
  const Hdf5Handle top(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  result.file_attributes = read_attributes(file);
  const bool in_raw = !result.group.empty();
  const ArrayChooser none = [](const std::string&) { return ArrayUse::kIgnore; };
  StoredGroup unused;
  for (const std::string& name : member_names(top)) {
    read_member(top, {.path = path, .channel = name}, in_raw ? none : chooser, result.file_attributes,
                in_raw ? unused : result);
  }
  if (!in_raw) return;
  const Hdf5Handle group(H5Gopen2(file, kRawGroup, H5P_DEFAULT), H5Gclose);
  result.group_attributes = read_attributes(group);
  result.group_attributes.erase("MATLAB_class");
  for (const std::string& name : member_names(group)) {
    read_member(group, {.path = path, .channel = name}, chooser, result.group_attributes, result);
  }
}

}  // namespace

StoredGroup read_hdf5(const std::string& path, bool raw, const ArrayChooser& chooser) {
  const Hdf5Silence silence;
  const Hdf5Handle file = open_file(path);
  StoredGroup result;
  if (raw && has_group(file, kRawGroup)) result.group = kRawGroup;
  try {
    read_members(file, path, chooser, result);
  } catch (const std::bad_alloc&) {
    throw InputError({.path = path}, "claims more than fits into memory",
                     "the file is damaged: record it again");
  } catch (const std::length_error&) {
    throw InputError({.path = path}, "claims more than fits into memory",
                     "the file is damaged: record it again");
  }
  return result;
}

bool is_hdf5(const std::string& path) {
  const Hdf5Silence silence;
  return H5Fis_hdf5(path.c_str()) > 0;
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

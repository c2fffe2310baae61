// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/hdf5_attributes.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "cli/recording/stored_text.hpp"

namespace hemi::recording {
namespace {

Json read_text(hid_t attribute, hid_t type) {
  const Hdf5Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_cset(memory, H5Tget_cset(type));
  if (H5Tis_variable_str(type) > 0) {
    H5Tset_size(memory, H5T_VARIABLE);
    char* text = nullptr;
    if (H5Aread(attribute, memory, &text) < 0 || text == nullptr) return nullptr;
    Json value = text_value(text);
    H5free_memory(text);
    return value;
  }
  // One byte more than stored: the library then always ends the text with a zero.
  std::vector<char> text(H5Tget_size(type) + 1);
  H5Tset_size(memory, text.size());
  if (H5Aread(attribute, memory, text.data()) < 0) return nullptr;
  return text_value(text.data());
}

extern "C" herr_t collect_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

}  // namespace

Json read_attribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return nullptr;
  const Hdf5Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1) return nullptr;
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_STRING) return read_text(attribute, type);
  if (kind == H5T_INTEGER) {
    std::int64_t value = 0;
    if (H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0) return nullptr;
    return value;
  }
  if (kind == H5T_FLOAT) {
    double value = 0.0;
    if (H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0) return nullptr;
    return value;
  }
  return nullptr;
}

Json read_attributes(hid_t object) {
  std::vector<std::string> names;
  if (H5Aiterate2(object, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect_attribute, &names) < 0) {
    names.clear();
    H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_attribute, &names);
  }
  Json attributes = Json::object();
  for (const std::string& name : names) {
    Json value = read_attribute(object, name);
    if (!value.is_null()) attributes[name] = std::move(value);
  }
  return attributes;
}

bool write_attribute(hid_t object, const std::string& name, const Json& value) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const auto put = [&](hid_t stored, hid_t memory, const void* data) {
    const Hdf5Handle attribute(H5Acreate2(object, name.c_str(), stored, space, H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    return attribute.ok() && H5Awrite(attribute, memory, data) >= 0;
  };
  if (value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();
    return put(H5T_STD_I64LE, H5T_NATIVE_INT64, &number);
  }
  if (value.is_number()) {
    const auto number = value.get<double>();
    return put(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &number);
  }
  const std::string text = value.is_string() ? value.get<std::string>() : json_text(value);
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_size(type, text.size() + 1);
  return put(type, type, text.c_str());
}

bool is_backed(hid_t dataset) {
  constexpr hsize_t kBestPacking = 1032;  // of deflate, by its format
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  return count >= 0 && static_cast<hsize_t>(count) <= kBestPacking * H5Dget_storage_size(dataset);
}

bool is_matlab_text(hid_t dataset) {
  return read_attribute(dataset, "MATLAB_class") == "char";
}

std::string matlab_text(hid_t dataset) {
  if (!is_backed(dataset)) return {};
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const auto count = std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0);
  std::vector<std::uint16_t> units(static_cast<std::size_t>(count));
  if (units.empty()) return {};
  if (H5Dread(dataset, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, units.data()) < 0) return {};
  return utf8_of_utf16(units);
}

}  // namespace hemi::recording

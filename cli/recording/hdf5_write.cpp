// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "cli/recording/error.hpp"
#include "cli/recording/hdf5_attributes.hpp"
#include "cli/recording/hdf5_file.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/partial_file.hpp"
#include "cli/recording/stored_text.hpp"

namespace hemi::recording {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw OutputError(path, "the HDF5 library refuses to build " + what, "shorten it or free some memory");
}

enum class Flavour { kHemi, kMatlab };

// "MAT-File Format", The MathWorks: 116 bytes of text, 8 of offset, version, order of bytes; padded to where
// the HDF5 file begins.
constexpr std::size_t kMatlabHeader_bytes = 512;

std::string matlab_header() {
  std::string header = "MATLAB 7.3 MAT-file, written by hemi HDF5 schema 1.00 .";
  header.resize(116, ' ');
  header.append(8, '\0');
  header += std::string("\x00\x02IM", 4);
  header.resize(kMatlabHeader_bytes, '\0');
  return header;
}

void track_creation_order(hid_t creation, Flavour flavour) {
  if (flavour == Flavour::kMatlab) return;  // older readers
  H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
}

// The file is built in memory: the library cannot be trusted to close a file on a full disk in good order,
// and bytes in hand can go through PartialFile like any others.
Hdf5Handle create_in_memory(const std::string& path, Flavour flavour) {
  constexpr std::size_t kGrowth = std::size_t{1} << 22;
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, kGrowth, false);
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  if (flavour == Flavour::kMatlab) {
    H5Pset_userblock(creation, kMatlabHeader_bytes);
  } else {
    // Newer object headers: attributes of any length, and the order of creation.
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  }
  track_creation_order(creation, flavour);
  H5Pset_obj_track_times(creation, false);
  return {H5Fcreate((path + ".in-memory").c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose};
}

// The group of that name, the top level where the name is empty.
Hdf5Handle create_group(hid_t root, const std::string& name, Flavour flavour) {
  if (name.empty()) return {H5Gopen2(root, "/", H5P_DEFAULT), H5Gclose};
  const Hdf5Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  track_creation_order(creation, flavour);
  H5Pset_obj_track_times(creation, false);
  return {H5Gcreate2(root, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose};
}

void write_attributes(hid_t object, const Json& attributes, const std::string& path) {
  for (const auto& [key, value] : attributes.items()) {
    if (!write_attribute(object, key, value)) refuse(path, "the attribute '" + key + "'");
  }
}

// A text attribute of exactly its length, as MATLAB expects its own.
bool write_class(hid_t object, const char* name) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::strlen(name));
  const Hdf5Handle attribute(H5Acreate2(object, "MATLAB_class", type, space, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  return attribute.ok() && H5Awrite(attribute, type, name) >= 0;
}

// Contiguous, without a date.
Hdf5Handle write_values(hid_t group, const std::string& name, std::vector<hsize_t> shape, hid_t stored,
                        hid_t memory, const void* data) {
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  Hdf5Handle dataset(H5Dcreate2(group, name.c_str(), stored, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                     H5Dclose);
  const bool written = dataset.ok() && H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
  return written ? std::move(dataset) : Hdf5Handle(-1, H5Dclose);
}

bool write_dataset(hid_t group, const OutputArray& output, Flavour flavour) {
  const auto* reals = std::get_if<const std::vector<double>*>(&output.values);
  const auto* integers = std::get_if<const std::vector<std::int32_t>*>(&output.values);
  const hsize_t length = reals != nullptr ? (*reals)->size() : (*integers)->size();
  const void* data = reals != nullptr ? static_cast<const void*>((*reals)->data()) : (*integers)->data();
  const bool matlab = flavour == Flavour::kMatlab;
  // HDF5 lists the sizes of a MATLAB array from the last one on.
  const Hdf5Handle dataset = write_values(
      group, output.name, matlab ? std::vector<hsize_t>{1, length} : std::vector<hsize_t>{length},
      reals != nullptr ? H5T_IEEE_F64LE : H5T_STD_I32LE,
      reals != nullptr ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT32, data);
  if (!dataset.ok()) return false;
  if (matlab) return write_class(dataset, reals != nullptr ? "double" : "int32");
  return output.unit.empty() || write_attribute(dataset, "unit", output.unit);
}

// ASCII alone, so that UTF-16 units are the characters.
bool write_matlab_text(hid_t group, const std::string& name, const std::string& ascii) {
  const std::vector<std::uint16_t> units(ascii.begin(), ascii.end());
  const Hdf5Handle dataset =
      write_values(group, name, {units.size(), 1}, H5T_STD_U16LE, H5T_NATIVE_UINT16, units.data());
  constexpr std::int32_t kUtf16 = 2;
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle decode(
      H5Acreate2(dataset, "MATLAB_int_decode", H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return dataset.ok() && write_class(dataset, "char") && H5Awrite(decode, H5T_NATIVE_INT32, &kUtf16) >= 0;
}

// The bytes of the file as the library holds them, without a copy, from the header before it on.
std::string_view image(hid_t file, const std::string& path, std::size_t header_bytes) {
  void* handle = nullptr;
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 || H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0) {
    refuse(path, "the file");
  }
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);  // tells the size, which begins behind the header
  if (size <= 0) refuse(path, "the file");
  return {*static_cast<const char* const*>(handle), header_bytes + static_cast<std::size_t>(size)};
}

void write_metadata(hid_t root, hid_t group, const OutputGroup& content, const std::string& path,
                    Flavour flavour) {
  if (flavour == Flavour::kHemi) {
    write_attributes(root, content.file_attributes, path);
    write_attributes(group, content.group_attributes, path);
    return;
  }
  if (!write_matlab_text(root, kSidecarVariable, ascii_json(content.file_attributes)))
    refuse(path, "the variable 'sidecar'");
  for (const auto& [key, value] : content.group_attributes.items()) {
    const std::vector<double> number = {value.get<double>()};
    if (!write_dataset(group, {key, "", &number}, flavour)) refuse(path, "the field '" + key + "'");
  }
  if (!content.group.empty() && !write_class(group, "struct")) refuse(path, "the struct " + content.group);
}

void write_in_memory(hid_t file, const OutputGroup& content, const std::string& path, Flavour flavour) {
  const Hdf5Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  const Hdf5Handle group = create_group(root, content.group, flavour);
  write_metadata(root, group, content, path, flavour);
  for (const OutputArray& array : content.arrays) {
    check_interrupt();
    if (!write_dataset(group, array, flavour)) refuse(path, "the dataset '" + array.name + "'");
  }
}

void write(const std::string& path, const OutputGroup& content, Flavour flavour) {
  const Hdf5Silence silence;
  PartialFile target(path);
  {
    const Hdf5Handle file = create_in_memory(path, flavour);
    if (!file.ok()) refuse(path, "the file");
    write_in_memory(file, content, path, flavour);
    const std::string header = flavour == Flavour::kMatlab ? matlab_header() : "";
    const std::string_view bytes = image(file, path, header.size());
    if (!bytes.substr(header.size()).starts_with("\x89HDF")) refuse(path, "the file's header");
    target.write(header);
    target.write(bytes.substr(header.size()));
  }
  target.commit();
}

}  // namespace

void write_hdf5_file(const std::string& path, const OutputGroup& content) {
  write(path, content, Flavour::kHemi);
}

void write_matlab73_file(const std::string& path, const OutputGroup& content) {
  write(path, content, Flavour::kMatlab);
}

}  // namespace hemi::recording

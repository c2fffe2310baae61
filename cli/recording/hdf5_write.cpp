// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/hdf5_attributes.hpp"
#include "cli/recording/hdf5_file.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/partial_file.hpp"

namespace hemi::recording {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw OutputError(path, "the HDF5 library refuses to build " + what, "shorten it or free some memory");
}

// The file is built in memory: the library cannot be trusted to close a file on a full disk in good order,
// and bytes in hand can go through PartialFile like any others.
Hdf5Handle create_in_memory(const std::string& path) {
  constexpr std::size_t kGrowth = std::size_t{1} << 22;
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, kGrowth, false);
  // Newer object headers: attributes of any length, and the order of creation.
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_obj_track_times(creation, false);
  return {H5Fcreate((path + ".in-memory").c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose};
}

// The group of that name, the top level where the name is empty.
Hdf5Handle create_group(hid_t root, const std::string& name) {
  if (name.empty()) return {H5Gopen2(root, "/", H5P_DEFAULT), H5Gclose};
  const Hdf5Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_obj_track_times(creation, false);
  return {H5Gcreate2(root, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose};
}

void write_attributes(hid_t object, const Json& attributes, const std::string& path) {
  for (const auto& [key, value] : attributes.items()) {
    if (!write_attribute(object, key, value)) refuse(path, "the attribute '" + key + "'");
  }
}

bool write_dataset(hid_t group, const Hdf5Output& output) {
  const auto* reals = std::get_if<const std::vector<double>*>(&output.values);
  const auto* integers = std::get_if<const std::vector<std::int32_t>*>(&output.values);
  const hsize_t length = reals != nullptr ? (*reals)->size() : (*integers)->size();
  const Hdf5Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  const Hdf5Handle dataset(
      H5Dcreate2(group, output.name.c_str(), reals != nullptr ? H5T_IEEE_F64LE : H5T_STD_I32LE, space,
                 H5P_DEFAULT, creation, H5P_DEFAULT),
      H5Dclose);
  if (!dataset.ok()) return false;
  const void* data = reals != nullptr ? static_cast<const void*>((*reals)->data()) : (*integers)->data();
  const hid_t memory = reals != nullptr ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT32;
  if (H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) return false;
  return output.unit.empty() || write_attribute(dataset, "unit", output.unit);
}

// The bytes of the file as the library holds them, without a copy.
std::string_view image(hid_t file, const std::string& path) {
  void* handle = nullptr;
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 || H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0) {
    refuse(path, "the file");
  }
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);  // no buffer: tells the size
  if (size <= 0) refuse(path, "the file");
  return {*static_cast<const char* const*>(handle), static_cast<std::size_t>(size)};
}

}  // namespace

void write_hdf5_file(const std::string& path, const Hdf5Content& content) {
  const Hdf5Silence silence;
  PartialFile target(path);
  {
    const Hdf5Handle file = create_in_memory(path);
    if (!file.ok()) refuse(path, "the file");
    {
      const Hdf5Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
      write_attributes(root, content.file_attributes, path);
      const Hdf5Handle group = create_group(root, content.group);
      write_attributes(group, content.group_attributes, path);
      for (const Hdf5Output& dataset : content.datasets) {
        check_interrupt();
        if (!write_dataset(group, dataset)) refuse(path, "the dataset '" + dataset.name + "'");
      }
    }
    target.write(image(file, path));
  }
  target.commit();
}

}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "cli/recording/error.hpp"
#include "cli/recording/hdf5_file.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/matlab_file.hpp"
#include "cli/recording/matlab_handle.hpp"
#include "cli/recording/partial_file.hpp"
#include "cli/recording/stored_text.hpp"

namespace hemi::recording {
namespace {

[[noreturn]] void refuse(const std::string& path, int reason) {
  throw OutputError(path, fmt::format("the MATLAB file cannot be built: {}", std::strerror(reason)),
                    "free some memory or space, or write .h5");
}

// The library opens files by name and does not tell of a full disk in all cases. It builds the file in
// memory, and the bytes go through PartialFile like any others.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& target) : target_(target) {
    descriptor_ = ::memfd_create("matlab", MFD_CLOEXEC);
    if (descriptor_ < 0) refuse(target_, errno);
  }
  ~MemoryFile() {
    if (bytes_ != MAP_FAILED) ::munmap(bytes_, size_);
    ::close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string name() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

  std::string_view bytes() {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) refuse(target_, errno);
    size_ = static_cast<std::size_t>(status.st_size);
    bytes_ = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, descriptor_, 0);
    if (bytes_ == MAP_FAILED) refuse(target_, errno);
    return {static_cast<const char*>(bytes_), size_};
  }

 private:
  std::string target_;
  int descriptor_ = -1;
  void* bytes_ = MAP_FAILED;
  std::size_t size_ = 0;
};

std::size_t value_bytes(const OutputArray& array) {
  return std::visit([](const auto* values) { return values->size() * sizeof(values->front()); },
                    array.values);
}

// A column whose data stays where it is.
MatlabVariable column(const OutputArray& array) {
  const auto* reals = std::get_if<const std::vector<double>*>(&array.values);
  const auto* integers = std::get_if<const std::vector<std::int32_t>*>(&array.values);
  std::array<std::size_t, 2> shape = {reals != nullptr ? (*reals)->size() : (*integers)->size(), 1};
  const void* data = reals != nullptr ? static_cast<const void*>((*reals)->data()) : (*integers)->data();
  return MatlabVariable(Mat_VarCreate(array.name.c_str(), reals != nullptr ? MAT_C_DOUBLE : MAT_C_INT32,
                                      reals != nullptr ? MAT_T_DOUBLE : MAT_T_INT32, 2, shape.data(),
                                      const_cast<void*>(data), MAT_F_DONT_COPY_DATA));  // only read
}

MatlabVariable number(const std::string& name, double value) {
  std::array<std::size_t, 2> shape = {1, 1};
  return MatlabVariable(Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape.data(), &value, 0));
}

// As UTF-16, the one form of text that all versions and readers share.
MatlabVariable text(const std::string& name, const std::string& ascii) {
  std::u16string units(ascii.begin(), ascii.end());
  std::array<std::size_t, 2> shape = {1, units.size()};
  return MatlabVariable(
      Mat_VarCreate(name.c_str(), MAT_C_CHAR, MAT_T_UINT16, 2, shape.data(), units.data(), 0));
}

MatlabVariable raw_struct(const OutputGroup& content) {
  std::vector<MatlabVariable> fields;
  for (const OutputArray& array : content.arrays) fields.push_back(column(array));
  for (const auto& [key, value] : content.group_attributes.items())
    fields.push_back(number(key, value.get<double>()));
  std::vector<const char*> names;
  for (const MatlabVariable& field : fields) names.push_back(field ? field->name : "");
  std::array<std::size_t, 2> shape = {1, 1};
  MatlabVariable result(Mat_VarCreateStruct(content.group.c_str(), 2, shape.data(), names.data(),
                                            static_cast<unsigned>(names.size())));
  for (std::size_t i = 0; result && i < fields.size(); ++i) {
    Mat_VarSetStructFieldByIndex(result.get(), i, 0, fields[i].release());  // the struct owns it
  }
  return result;
}

std::vector<MatlabVariable> variables(const OutputGroup& content) {
  std::vector<MatlabVariable> result;
  if (content.group.empty()) {
    for (const OutputArray& array : content.arrays) result.push_back(column(array));
  } else {
    result.push_back(raw_struct(content));
  }
  result.push_back(text(kSidecarVariable, ascii_json(content.file_attributes)));
  return result;
}

// True where everything is in the file.
bool build(const std::string& name, const OutputGroup& content) {
  MatlabFile file(Mat_CreateVer(name.c_str(), "MATLAB 5.0 MAT-file, written by hemi", MAT_FT_MAT5));
  if (!file) return false;
  for (const MatlabVariable& variable : variables(content)) {
    check_interrupt();
    if (!variable || Mat_VarWrite(file.get(), variable.get(), MAT_COMPRESSION_NONE) != 0) return false;
  }
  return Mat_Close(file.release()) == 0;
}

}  // namespace

void write_matlab_file(const std::string& path, const OutputGroup& content, std::size_t v73_from_bytes) {
  std::size_t bytes = 0;
  for (const OutputArray& array : content.arrays) bytes += value_bytes(array);
  if (bytes >= v73_from_bytes) return write_matlab73_file(path, content);
  PartialFile target(path);
  MemoryFile memory(path);
  errno = 0;
  const bool built = build(memory.name(), content);
  const int reason = errno != 0 ? errno : EIO;
  const std::string_view image = memory.bytes();
  if (!built || image.size() < bytes) refuse(path, reason);
  target.write(image);
  target.commit();
}

}  // namespace hemi::recording

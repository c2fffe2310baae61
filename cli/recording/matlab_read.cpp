// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>

#include "cli/recording/error.hpp"
#include "cli/recording/hdf5_file.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/matlab_file.hpp"
#include "cli/recording/matlab_values.hpp"
#include "cli/recording/matlab_version.hpp"

namespace hemi::recording {
namespace {

constexpr const char* kAgain = "copy or save it again";

// Variables of a v5 or v7 file, one after another.
class Variables {
 public:
  explicit Variables(const std::string& path)
      : path_(path),
        count_(count_matlab_variables(path)),
        size_bytes_(static_cast<double>(std::filesystem::file_size(path))),
        file_(Mat_Open(path.c_str(), MAT_ACC_RDONLY)) {
    if (!file_) throw InputError({.path = path}, "the MATLAB file is damaged", kAgain);
  }

  /// Name, class and sizes of the next one; nullptr behind the last.
  MatlabVariable next() {
    check_interrupt();
    MatlabVariable variable(Mat_VarReadNextInfo(file_.get()));
    if (variable) {
      ++taken_;
    } else if (taken_ < count_) {
      throw InputError({.path = path_}, fmt::format("variable {} is damaged or cut off", taken_ + 1), kAgain);
    }
    return variable;
  }

  /// Reads the values of what next() returned.
  void read(matvar_t& variable, const Place& place) {
    constexpr double kBestPacking = 1032.0;  // of deflate, by its format
    if (claimed_bytes(variable) > kBestPacking * size_bytes_) {
      throw InputError(place, "claims more values than its bytes in the file can hold", kAgain);
    }
    const bool many = variable.class_type == MAT_C_STRUCT && claimed_elements(variable) != 1.0;
    if (many) throw InputError(place, "is an array of structs", "store a struct of one element");
    if (Mat_VarReadDataAll(file_.get(), &variable) != 0) {
      throw InputError(place, "cannot be read: damaged or cut off", kAgain);
    }
  }

 private:
  std::string path_;
  std::size_t count_;
  double size_bytes_;
  MatlabFile file_;
  std::size_t taken_ = 0;
};

std::string name_of(const matvar_t& variable) {
  return variable.name == nullptr ? "" : variable.name;
}

// Fields of the struct `raw` are arrays like those at the top level.
bool is_raw_struct(const matvar_t& variable) {
  return variable.class_type == MAT_C_STRUCT && name_of(variable) == kRawGroup;
}

// A variable, or a field of `raw`, whose values are there.
void take(const matvar_t& variable, const Place& place, const ArrayChooser& chooser, Json& attributes,
          StoredGroup& group) {
  if (variable.class_type == MAT_C_CHAR || place.channel == kSidecarVariable) {
    attributes[place.channel] = matlab_value(variable);
    return;
  }
  const ArrayUse use = chooser(place.channel);
  if (use == ArrayUse::kIgnore) return;
  const std::string kind = unusable_kind(variable);
  if (!kind.empty()) throw InputError(place, "is a " + kind, matlab_remedy(kind, place.channel));
  auto values = vector_values(variable);
  if (!values) throw InputError(place, "cannot be read: damaged or cut off", kAgain);
  if (use == ArrayUse::kChannel) {
    group.arrays.push_back({place.channel, "", std::move(*values)});
  } else if (values->size() == 1) {
    attributes[place.channel] = values->front();
  } else {
    throw InputError(place, "is not a single number", "store one number");
  }
}

void take_fields(matvar_t& variable, const std::string& path, const ArrayChooser& chooser,
                 StoredGroup& group) {
  char* const* names = Mat_VarGetStructFieldnames(&variable);
  for (std::size_t i = 0; names != nullptr && i < Mat_VarGetNumberOfFields(&variable); ++i) {
    const matvar_t* field = Mat_VarGetStructFieldByIndex(&variable, i, 0);
    if (names[i] == nullptr || field == nullptr) continue;
    take(*field, {.path = path, .channel = names[i]}, chooser, group.group_attributes, group);
  }
}

bool has_raw_struct(const std::string& path) {
  Variables variables(path);
  bool found = false;
  while (const MatlabVariable variable = variables.next()) found = found || is_raw_struct(*variable);
  return found;
}

StoredGroup read_v5(const std::string& path, bool raw, const ArrayChooser& chooser) {
  StoredGroup group;
  if (raw && has_raw_struct(path)) group.group = kRawGroup;
  Variables variables(path);
  while (const MatlabVariable variable = variables.next()) {
    const Place place{.path = path, .channel = name_of(*variable)};
    if (place.channel.empty()) continue;  // what objects refer to
    const bool fields = is_raw_struct(*variable);
    const bool text = variable->class_type == MAT_C_CHAR || place.channel == kSidecarVariable;
    const bool wanted = fields ? !group.group.empty() : text || group.group.empty();
    if (!wanted || (!text && !fields && chooser(place.channel) == ArrayUse::kIgnore)) continue;
    // What is refused for its kind is not read at all.
    if (text || fields || unusable_kind(*variable).empty()) variables.read(*variable, place);
    if (fields) {
      take_fields(*variable, path, chooser, group);
    } else {
      take(*variable, place, chooser, group.file_attributes, group);
    }
  }
  return group;
}

// The keys inside the variable `sidecar` become attributes of the file.
void unpack_sidecar(StoredGroup& group, const std::string& path) {
  const auto found = group.file_attributes.find(kSidecarVariable);
  if (found == group.file_attributes.end()) return;
  if (!found->is_object()) {
    throw InputError({.path = path, .channel = kSidecarVariable}, "is neither a struct nor a JSON object",
                     "store a struct, or jsonencode of one");
  }
  const Json keys = *found;
  group.file_attributes.erase(kSidecarVariable);
  for (const auto& [key, value] : keys.items()) group.file_attributes[key] = value;
}

}  // namespace

StoredGroup read_matlab(const std::string& path, bool raw, const ArrayChooser& chooser) {
  const bool hdf5 = matlab_version(path) == MatlabVersion::k73;
  try {
    StoredGroup group = hdf5 ? read_hdf5(path, raw, chooser) : read_v5(path, raw, chooser);
    unpack_sidecar(group, path);
    return group;
  } catch (const std::bad_alloc&) {
    throw InputError({.path = path}, "claims more than fits into memory",
                     "the file is damaged: save it again");
  }
}

std::vector<std::string> matlab_names(const std::string& path) {
  if (matlab_version(path) == MatlabVersion::k73) return hdf5_dataset_names(path);
  std::vector<std::string> names;
  Variables variables(path);
  while (const MatlabVariable variable = variables.next()) {
    const std::string name = name_of(*variable);
    if (is_raw_struct(*variable)) {
      char* const* fields = Mat_VarGetStructFieldnames(variable.get());
      for (std::size_t i = 0; fields != nullptr && i < Mat_VarGetNumberOfFields(variable.get()); ++i) {
        if (fields[i] != nullptr) names.push_back(std::string(kRawGroup) + "/" + fields[i]);
      }
    } else if (!name.empty() && name != kSidecarVariable && variable->class_type != MAT_C_CHAR) {
      names.push_back(name);
    }
  }
  return names;
}

}  // namespace hemi::recording

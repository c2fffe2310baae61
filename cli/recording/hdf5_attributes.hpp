// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/recording/hdf5_handle.hpp"
#include "cli/recording/json.hpp"

namespace hemi::recording {

/// Attribute of a file, group or dataset: a single number or a text. Text that is a JSON object, array, truth
/// value or null comes back as such (HDF5 has no nested attributes). Null where absent or of another kind.
Json read_attribute(hid_t object, const std::string& name);

/// All attributes that read_attribute understands.
Json read_attributes(hid_t object);

/// The reverse of read_attribute; false where the library refuses.
bool write_attribute(hid_t object, const std::string& name, const Json& value);

/// False where a dataset claims more values than its bytes in the file can unpack to (damaged, or never
/// written).
bool is_backed(hid_t dataset);

/// MATLAB stores text as a dataset of UTF-16 units with the attribute MATLAB_class = "char".
bool is_matlab_text(hid_t dataset);
std::string matlab_text(hid_t dataset);

}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/recording/stored_group.hpp"

namespace hemi::recording {

/// Vectors of a MATLAB file: variables, or the fields of the struct `raw` where `raw` is true and the struct
/// is there. The version is found in the header: v5 and v7 are read by libmatio, v7.3 as HDF5. The variable
/// `sidecar` (JSON text or struct) holds metadata, and so does any variable with text. InputError with the
/// remedy: v4 and other versions, damaged, cut off, wanted variables that are no vectors of real numbers
/// (matrix, struct, cell, table, object, sparse, complex).
StoredGroup read_matlab(const std::string& path, bool raw, const ArrayChooser& chooser);

/// Names of the variables that may be channels, as read_matlab sees them; fields of `raw` as "raw/NAME".
std::vector<std::string> matlab_names(const std::string& path);

/// v5 counts the bytes of a variable in 32 bits, which many readers take for signed.
inline constexpr std::size_t kMatlab73_bytes = (std::size_t{1} << 31) - (std::size_t{1} << 20);

/// Column vectors (double or int32), in the struct `raw` where the content has that group, and `sidecar` as
/// JSON text. Format v5 without compression, v7.3 where the values take at least `v73_from_bytes`. The file
/// appears whole or not at all; OutputError otherwise.
void write_matlab_file(const std::string& path, const OutputGroup& content,
                       std::size_t v73_from_bytes = kMatlab73_bytes);

}  // namespace hemi::recording

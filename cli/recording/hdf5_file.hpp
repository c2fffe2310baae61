// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/recording/stored_group.hpp"

namespace hemi::recording {

/// One-dimensional (or n x 1) integer and floating-point datasets of the group `raw`, where `raw` is true and
/// the group is there, else of the top level; MATLAB's v7.3 .mat is such a file. InputError: not HDF5,
/// damaged, other types or shapes of wanted datasets.
StoredGroup read_hdf5(const std::string& path, bool raw, const ArrayChooser& chooser);

/// Names of the numeric datasets: top level as they are, those of the group `raw` as "raw/NAME".
std::vector<std::string> hdf5_dataset_names(const std::string& path);

/// By its first bytes, or those behind a user block.
bool is_hdf5(const std::string& path);

/// The file appears whole or not at all; OutputError otherwise. Equal content gives equal bytes.
void write_hdf5_file(const std::string& path, const OutputGroup& content);

/// The same content as MATLAB's v7.3 has it: a header of 512 bytes before the HDF5 file, columns, the group
/// `raw` as a struct with its attributes as fields, the file's attributes as JSON text in `sidecar`.
void write_matlab73_file(const std::string& path, const OutputGroup& content);

}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/recording/error.hpp"
#include "cli/recording/json.hpp"
#include "cli/recording/sidecar.hpp"

namespace hemi::recording {

struct Column {
  std::string name{};            ///< channel, or the file's own name where nothing was resolved
  std::vector<double> values{};  ///< NaN: missing
};

/// Columns of equal length out of a CSV, HDF5 or MATLAB file.
struct Table {
  std::string path{};
  std::size_t first_line = 0;  ///< line of row 0 in a text file, 0 in others
  std::vector<Column> columns{};
  Json metadata = Json::object();  ///< attributes of an HDF5 file, the sidecar in a MATLAB file
  std::vector<std::string> notes{};

  const Column* find(std::string_view name) const;
  std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  /// Where row `row` (from 0) of a channel stands in the file.
  Place place(std::size_t row, std::string channel) const;
};

enum class FileKind { kCsv, kHdf5, kMatlab, kSound };

/// By extension (.csv, .txt; .h5, .hdf5; .mat; .wav, .flac, ...), else by the first bytes. InputError where
/// the file is missing, empty, a directory or unreadable.
FileKind file_kind(const std::string& path);

/// A CSV, HDF5 or MATLAB file with its columns resolved to channels and scaled. In HDF5 the group `raw`, in
/// MATLAB the struct, where `raw` is true and it is there, otherwise the top level.
Table load_channels(const std::string& path, FileKind kind, const Sidecar& sidecar, bool raw);

/// Names of the columns alone, as in the file; of the group `raw` as "raw/NAME".
std::vector<std::string> column_names(const std::string& path, FileKind kind);

}  // namespace hemi::recording

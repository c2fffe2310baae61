// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/recording/raw_capture.hpp"
#include "cli/recording/recording.hpp"

namespace hemi::recording {

// All writers: numbers in the shortest form that reads back to the same double, NaN as an empty cell (CSV) or
// as NaN (HDF5, MATLAB). A file appears whole or not at all. OutputError where it cannot be written (full
// disk, infinite value), std::invalid_argument for channels of unequal length.

/// NAME.csv, and NAME.json with the sidecar's keys (format, device and sample_rate_hz filled in).
void write_csv(const std::string& path, const Recording& recording);

/// One file; the sidecar's keys become attributes (objects as JSON text).
void write_hdf5(const std::string& path, const Recording& recording);

/// One file: column vectors, and the sidecar's keys as JSON text in the variable `sidecar`.
void write_matlab(const std::string& path, const Recording& recording);

/// NAME.raw.csv: adc_x, adc_y, after a time_s where there are gaps; key `raw` is set in the sidecar beside
/// it, whose other keys stay.
void write_csv(const std::string& path, const RawCapture& capture);

/// Group `raw` with integer datasets and its rate and full scale as attributes.
void write_hdf5(const std::string& path, const RawCapture& capture);

/// Struct `raw` with integer vectors and its rate and full scale as numbers; `sidecar` as above.
void write_matlab(const std::string& path, const RawCapture& capture);

/// Files that hold their sidecar inside: by extension .h5, .hdf5 HDF5, .mat MATLAB. All others are CSV.
enum class OutputKind { kCsv, kHdf5, kMatlab };
OutputKind output_kind(const std::string& path);

/// By output_kind.
void write_file(const std::string& path, const Recording& recording);
void write_file(const std::string& path, const RawCapture& capture);

/// Any text (JSON, HTML, ...) in the same way: whole or not at all.
void write_text(const std::string& path, std::string_view text);

}  // namespace hemi::recording

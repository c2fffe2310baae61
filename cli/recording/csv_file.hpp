// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/recording/table.hpp"

namespace hemi::recording {

/// Says which columns of the header are wanted; the others are not read as numbers.
using ColumnChooser =
    std::function<std::vector<bool>(const std::vector<std::string>& names, const Place& place)>;

/// Numbers of a comma-separated file: `#` lines, a header (RFC 4180 quotes), one row a line. UTF-8 mark,
/// CRLF, blanks around cells and blank lines at the end are tolerated; empty and `nan` are NaN. InputError
/// for everything else: another separator, another number of cells, text, infinities, binary bytes, no row.
/// Without a chooser all columns are read. Columns keep the names of the header.
Table read_csv(const std::string& path, const ColumnChooser& chooser = {});

/// Names in the header of a comma-separated file.
std::vector<std::string> read_csv_header(const std::string& path);

}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hemi::recording {

/// Where in a file something is wrong. Lines count from 1 and belong to text files; rows count from 1 and
/// belong to files without lines (HDF5, sound). Zero or empty: not known, left out of the message.
struct Place {
  std::string path{};
  std::size_t line = 0;
  std::size_t row = 0;
  std::string channel{};
};

/// Bad input. what() is one line: `file:line: channel: problem; remedy`. The program exits with 2.
class InputError : public std::runtime_error {
 public:
  InputError(const Place& place, std::string_view problem, std::string_view remedy);
};

/// A file that could not be written (full disk, no such directory, ...), one line as above.
class OutputError : public std::runtime_error {
 public:
  OutputError(const std::string& path, std::string_view problem, std::string_view remedy);
};

/// Text from a file, fit to stand in a one-line message: in quotes, control bytes as \xNN, at most 48 bytes.
std::string in_quotes(std::string_view text);

/// InputError unless `path` exists, can be opened and is neither a directory nor an empty file.
void require_readable(const std::string& path);

}  // namespace hemi::recording

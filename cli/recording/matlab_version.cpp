// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/matlab_version.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "cli/recording/error.hpp"
#include "cli/recording/hdf5_file.hpp"

namespace hemi::recording {
namespace {

// "MAT-File Format", The MathWorks: 116 bytes of text, 8 of offset, version, and "MI" in the writer's order.
constexpr std::size_t kHeader_bytes = 128;
constexpr std::size_t kVersionAt = 124;

struct Header {
  std::array<unsigned char, kHeader_bytes> bytes{};
  std::size_t length = 0;

  bool little() const { return bytes[126] == 'I' && bytes[127] == 'M'; }
  bool big() const { return bytes[126] == 'M' && bytes[127] == 'I'; }
  unsigned version() const {
    const unsigned first = bytes[kVersionAt], second = bytes[kVersionAt + 1];
    return little() ? second << 8 | first : first << 8 | second;
  }
};

Header read_header(std::ifstream& file) {
  Header header;
  file.read(reinterpret_cast<char*>(header.bytes.data()), kHeader_bytes);
  header.length = static_cast<std::size_t>(file.gcount());
  return header;
}

std::uint32_t word(const unsigned char* bytes, bool little) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | bytes[little ? 3 - i : i];
  return value;
}

// A v4 file starts with the first variable: type MOPT (0 to 4052, its hundreds 0), rows, columns, whether
// imaginary parts follow, length of the name.
bool is_v4(const Header& header) {
  if (header.length < 21) return false;
  for (const bool little : {true, false}) {
    const auto at = [&](std::size_t i) { return word(header.bytes.data() + 4 * i, little); };
    const std::uint32_t type = at(0);
    if (type <= 4052 && type / 100 % 10 == 0 && type / 10 % 10 <= 5 && type % 10 <= 2 && at(3) <= 1 &&
        at(4) >= 1 && at(4) <= 64) {
      return true;
    }
  }
  return false;
}

constexpr const char* kDamaged = "copy or save it again";

}  // namespace

MatlabVersion matlab_version(const std::string& path) {
  require_readable(path);
  if (is_hdf5(path)) return MatlabVersion::k73;
  std::ifstream file(path, std::ios::binary);
  const Header header = read_header(file);
  const std::string_view text(reinterpret_cast<const char*>(header.bytes.data()), header.length);
  if (header.length == kHeader_bytes && (header.little() || header.big())) {
    if (header.version() == 0x0100) return MatlabVersion::k5;
    if (header.version() == 0x0200)
      throw InputError({.path = path}, "a MATLAB v7.3 file that is damaged or cut off", kDamaged);
    throw InputError(
        {.path = path},
        fmt::format("a MATLAB file of version {:#06x}, which is neither v5, v7 nor v7.3", header.version()),
        "save it with save(..., '-v7')");
  }
  if (text.starts_with("MATLAB"))
    throw InputError({.path = path}, "a MATLAB file whose header is damaged or cut off", kDamaged);
  if (is_v4(header)) {
    throw InputError({.path = path}, "a MATLAB v4 file",
                     "load it into MATLAB or Octave and save it with save(..., '-v7')");
  }
  throw InputError({.path = path}, "not a MATLAB file",
                   "check that the file is complete and its name ends as its kind demands");
}

std::size_t count_matlab_variables(const std::string& path) {
  constexpr std::uint64_t kTag_bytes = 8;
  std::ifstream file(path, std::ios::binary);
  const bool little = read_header(file).little();
  const std::uint64_t size = std::filesystem::file_size(path);
  std::size_t count = 0;
  for (std::uint64_t at = kHeader_bytes; at < size; ++count) {
    unsigned char tag[kTag_bytes] = {};
    file.seekg(static_cast<std::streamoff>(at));
    file.read(reinterpret_cast<char*>(tag), kTag_bytes);
    at += kTag_bytes + word(tag + 4, little);
    if (!file || at > size) {
      throw InputError({.path = path}, fmt::format("variable {} is damaged or cut off", count + 1), kDamaged);
    }
  }
  return count;
}

std::string matlab_remedy(const std::string& kind, const std::string& variable) {
  if (kind == "struct")
    return fmt::format("save its fields as variables: save(..., '-struct', '{}')", variable);
  if (kind == kMatlabObject) {
    return fmt::format(
        "save a table's columns as variables: s = table2struct({}, 'ToScalar', true); save(..., '-struct', "
        "'s')",
        variable);
  }
  return "save full vectors of real numbers, or map it to null under \"columns\" in the sidecar";
}

}  // namespace hemi::recording

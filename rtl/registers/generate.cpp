// SPDX-License-Identifier: Apache-2.0
// hemi_registers COMMAND TREE BUILD: files that follow from the description of the registers. write: those of
// the source tree; check: fails where one of them is stale; build: those in the directory BUILD.
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "rtl/registers/description.hpp"

namespace hemi::registers {
namespace {

struct File {
  std::filesystem::path path;
  std::string text;
  bool in_tree;
};

std::vector<File> files(const std::filesystem::path& tree, const std::filesystem::path& build) {
  return {{tree / "rtl/axi/hemi_axi_pkg.sv", axi_package(), true},
          {tree / "rtl/board/hemi_board_pkg.sv", board_package(), true},
          {tree / "docs/registers.md", table(), true},
          {build / "hemi_registers.h", c_header(), false},
          {build / "hemi_registers_pkg.sv", register_package(), false}};
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const File& file) {
  std::filesystem::create_directories(file.path.parent_path());
  std::ofstream out(file.path, std::ios::binary);
  out << file.text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.path.string());
}

int run(const std::string& command, const std::filesystem::path& tree, const std::filesystem::path& build) {
  int stale = 0;
  for (const File& file : files(tree, build)) {
    if (command == "build" && !file.in_tree) write(file);
    if (command == "write" && file.in_tree && content(file.path) != file.text) {
      write(file);
      fmt::print("wrote {}\n", file.path.string());
    }
    if (command == "check" && file.in_tree && content(file.path) != file.text) {
      fmt::print(stderr, "{} is stale: scripts/registers writes it\n", file.path.string());
      ++stale;
    }
  }
  return stale > 0 ? 1 : 0;
}

}  // namespace
}  // namespace hemi::registers

int main(int argc, char** argv) {
  try {
    const std::string command = argc == 4 ? argv[1] : "";
    if (command != "write" && command != "check" && command != "build")
      throw std::runtime_error("usage: hemi_registers write|check|build TREE BUILD");
    return hemi::registers::run(command, argv[2], argv[3]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "hemi_registers: {}\n", error.what());
    return 2;
  }
}

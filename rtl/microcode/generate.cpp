// SPDX-License-Identifier: Apache-2.0
// hemi_microcode INSTRUMENT DIRECTORY: writes the generated SystemVerilog and the listing of one instrument.
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "rtl/microcode/blocks.hpp"
#include "rtl/microcode/listing.hpp"
#include "rtl/microcode/systemverilog.hpp"

namespace hemi::microcode {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

void generate(const std::string& name, const std::filesystem::path& directory) {
  const bool wide = name == "wide";
  if (!wide && name != "reference") throw std::runtime_error("no instrument " + name + ": reference or wide");
  Assembler m(wide ? instrument<config::Wide>(name) : instrument<config::Reference>(name));
  write_program(m);
  const Schedule s = schedule(m);
  std::filesystem::create_directories(directory);
  write(directory / "hemi_pkg.sv", package(m, s));
  write(directory / "hemi_program.sv", program_memory(m, s));
  write(directory / "hemi_modes.sv", mode_table(m));
  write(directory / "hemi_constants.sv", constant_table(m));
  write(directory / "hemi_sine_rom.sv", sine_memory());
  write(directory / "program.lst", listing(m, s));
  write(directory / "summary.txt", summary(m, s));
}

}  // namespace
}  // namespace hemi::microcode

int main(int argc, char** argv) {
  try {
    if (argc != 3) throw std::runtime_error("usage: hemi_microcode reference|wide DIRECTORY");
    hemi::microcode::generate(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "hemi_microcode: {}\n", error.what());
    return 2;
  }
}

// SPDX-License-Identifier: Apache-2.0
// The generated SystemVerilog: constants, program, table.
#ifndef HEMI_RTL_MICROCODE_SYSTEMVERILOG_HPP
#define HEMI_RTL_MICROCODE_SYSTEMVERILOG_HPP

#include <string>

#include "rtl/microcode/assembler.hpp"
#include "rtl/microcode/schedule.hpp"

namespace hemi::microcode {

/// Bits of the program address.
int program_bits(const Schedule& s);

std::string package(const Assembler& m, const Schedule& s);         ///< hemi_pkg.sv
std::string program_memory(const Assembler& m, const Schedule& s);  ///< hemi_program.sv
std::string mode_table(const Assembler& m);                         ///< hemi_modes.sv
std::string constant_table(const Assembler& m);                     ///< hemi_constants.sv
std::string sine_memory();                                          ///< hemi_sine_rom.sv

}  // namespace hemi::microcode

#endif  // HEMI_RTL_MICROCODE_SYSTEMVERILOG_HPP

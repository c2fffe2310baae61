// SPDX-License-Identifier: Apache-2.0
// What is written from the one description of the registers: hls/config.hpp and rtl/address_map.hpp.
#ifndef HEMI_RTL_REGISTERS_DESCRIPTION_HPP
#define HEMI_RTL_REGISTERS_DESCRIPTION_HPP

#include <string>

namespace hemi::registers {

/// hemi_registers.h: C99 and C++, indices, formats, addresses, status bits, conversions.
std::string c_header();
/// hemi_registers_pkg.sv: the same names for logic that writes registers or reads records.
std::string register_package();
/// hemi_axi_pkg.sv and hemi_board_pkg.sv, which rtl/axi and rtl/board are built on.
std::string axi_package();
std::string board_package();
/// docs/registers.md.
std::string table();

/// nco_start to NCO_START and NcoStart.
std::string upper(std::string name);
std::string pascal(const std::string& name);

}  // namespace hemi::registers

#endif  // HEMI_RTL_REGISTERS_DESCRIPTION_HPP

// SPDX-License-Identifier: Apache-2.0
// A register image as text: JSON, C array, SystemVerilog parameter, memory file.
#ifndef HEMI_CLI_REGISTER_IMAGE_HPP
#define HEMI_CLI_REGISTER_IMAGE_HPP

#include <string>

#include "tb/engine.hpp"

namespace hemi::cli {

/// Each register with its value, unit, raw word and meaning; the difference from `values` that rounding made.
std::string image_as_json(const tb::RegisterImage& image, const tb::RegisterValues& values,
                          const std::string& device);

/// C99 and C++: hemi_register_image, raw words in the order of the registers. Stands alone, and beside
/// hemi_registers.h.
std::string image_as_c(const tb::RegisterImage& image, const std::string& device);

/// Package hemi_register_image_pkg: all words in one vector, word i in bits 54 i and up.
std::string image_as_systemverilog(const tb::RegisterImage& image, const std::string& device);

/// For $readmemh: a word of 54 bits a line, in the order of the registers.
std::string image_as_memory(const tb::RegisterImage& image);

}  // namespace hemi::cli

#endif  // HEMI_CLI_REGISTER_IMAGE_HPP

// SPDX-License-Identifier: Apache-2.0
// The scheduled program for people.
#ifndef HEMI_RTL_MICROCODE_LISTING_HPP
#define HEMI_RTL_MICROCODE_LISTING_HPP

#include <string>

#include "rtl/microcode/schedule.hpp"

namespace hemi::microcode {

std::string listing(const Assembler& m, const Schedule& s);  ///< program.lst: address, block, instruction
std::string summary(const Assembler& m, const Schedule& s);  ///< summary.txt: clocks and words

}  // namespace hemi::microcode

#endif  // HEMI_RTL_MICROCODE_LISTING_HPP

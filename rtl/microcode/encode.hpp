// SPDX-License-Identifier: Apache-2.0
// The microinstruction as bits.
#ifndef HEMI_RTL_MICROCODE_ENCODE_HPP
#define HEMI_RTL_MICROCODE_ENCODE_HPP

#include <array>
#include <cstdint>

#include "rtl/microcode/schedule.hpp"

namespace hemi::microcode {

struct Field {
  const char* name;
  int width;
};

/// From the lowest bit up. A jump's target stands in b and a.
constexpr std::array<Field, 11> fields = {{{"B", operand_b_bits},
                                           {"A", address_bits},
                                           {"Dst", address_bits},
                                           {"Shift", 6},
                                           {"Round", 1},
                                           {"Mode", 5},
                                           {"Operation", 3},
                                           {"Condition", 2},
                                           {"SetsNegative", 1},
                                           {"Event", 5},
                                           {"Control", 3}}};

constexpr int instruction_bits = [] {
  int bits = 0;
  for (const Field& field : fields) bits += field.width;
  return bits;
}();

std::uint64_t encode(const Instruction& i, const Assembler& m, const Schedule& s);

}  // namespace hemi::microcode

#endif  // HEMI_RTL_MICROCODE_ENCODE_HPP

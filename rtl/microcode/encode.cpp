// SPDX-License-Identifier: Apache-2.0
#include "rtl/microcode/encode.hpp"

#include <stdexcept>

namespace hemi::microcode {

std::uint64_t encode(const Instruction& i, const Assembler& m, const Schedule& s) {
  const auto address = [&](Word word) {
    return word.address < symbolic_base ? word.address : s.addresses.at(word.address);
  };
  int a = address(i.a);
  int b = address(i.b);
  if (i.control == Control::jump) {
    const int target = s.entries.at(i.target);
    a = target >> operand_b_bits;
    b = target & ((1 << operand_b_bits) - 1);
  }
  const std::array<int, fields.size()> values = {b,
                                                 a,
                                                 address(i.dst),
                                                 i.shift,
                                                 i.round_half_up ? 1 : 0,
                                                 m.mode_code(i.mode),
                                                 static_cast<int>(i.operation),
                                                 static_cast<int>(i.condition),
                                                 i.sets_negative ? 1 : 0,
                                                 i.event,
                                                 static_cast<int>(i.control)};
  std::uint64_t word = 0;
  int position = 0;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (values[f] < 0 || values[f] >= 1 << fields[f].width) {
      throw std::logic_error(std::string(fields[f].name) + " does not fit the instruction");
    }
    word |= static_cast<std::uint64_t>(values[f]) << position;
    position += fields[f].width;
  }
  return word;
}

}  // namespace hemi::microcode

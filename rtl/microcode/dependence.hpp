// SPDX-License-Identifier: Apache-2.0
// Which instruction has to wait for which, and for how many clocks.
#ifndef HEMI_RTL_MICROCODE_DEPENDENCE_HPP
#define HEMI_RTL_MICROCODE_DEPENDENCE_HPP

#include <vector>

#include "rtl/microcode/assembler.hpp"

namespace hemi::microcode {

bool reads_a(const Instruction& i);
bool reads_b(const Instruction& i);  ///< from the state memory
bool reads(const Instruction& i, Word word);
bool writes(const Instruction& i, Word nowhere);
/// Multiplications, look-ups and words with a residual: the next line takes their result, exactly so many
/// clocks later (0: none of them).
int result_latency(const Instruction& i);

/// Clocks from `first` to `second`, which stands behind it in the text; 0 when they may go in any order.
int distance(const Instruction& first, const Instruction& second, Word nowhere);

}  // namespace hemi::microcode

#endif  // HEMI_RTL_MICROCODE_DEPENDENCE_HPP

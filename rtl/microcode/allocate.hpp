// SPDX-License-Identifier: Apache-2.0
// Addresses for the words that a program knows by name.
#ifndef HEMI_RTL_MICROCODE_ALLOCATE_HPP
#define HEMI_RTL_MICROCODE_ALLOCATE_HPP

#include "rtl/microcode/schedule.hpp"

namespace hemi::microcode {

/// Fills in s.addresses and s.state_end. A word that lives within one region, from a write at which it owes
/// nothing to its past until its last use, gives its address to the next of its kind (samples interrupt the
/// background: they have their own); all others keep one to themselves. Throws std::logic_error when the
/// state memory is full.
void allocate(const Assembler& m, Schedule& s);

}  // namespace hemi::microcode

#endif  // HEMI_RTL_MICROCODE_ALLOCATE_HPP

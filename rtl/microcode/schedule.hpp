// SPDX-License-Identifier: Apache-2.0
// List scheduling of a program: every instruction gets the clock at which its operands are there.
#ifndef HEMI_RTL_MICROCODE_SCHEDULE_HPP
#define HEMI_RTL_MICROCODE_SCHEDULE_HPP

#include <map>
#include <string>
#include <vector>

#include "rtl/microcode/assembler.hpp"

namespace hemi::microcode {

/// Clocks a sample that the background must leave to spare: 12 MHz at 100 kS/s has 120, two are for the
/// hand-over.
constexpr int clocks_per_sample = 118;

struct Schedule {
  std::vector<Instruction> program;
  std::map<std::string, int> entries;  ///< address of each region
  std::map<std::string, int> clocks;   ///< length of each region
  std::map<int, int> addresses;        ///< of the words that the program knows by name
  int state_end = 0;                   ///< first address behind them
  int longest_slice = 0;               ///< most clocks between two places at which a sample may go first
};

/// Places all regions; throws std::logic_error when a word is read but never written, or written and never
/// read, when a stretch between two yields is too long, or when the background does not fit its samples.
Schedule schedule(const Assembler& m);

}  // namespace hemi::microcode

#endif  // HEMI_RTL_MICROCODE_SCHEDULE_HPP

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "golden/concealed/instrument.hpp"

namespace hemi::concealed {

/// What is done to the instrument besides its temperature.
enum Stimulus : unsigned {
  kTurn = 1,         ///< rate table, both signs, several speeds
  kSteps = 2,        ///< steps of the amplitude
  kTumble = 4,       ///< flips: specific force -1, 0, 1 g
  kTilts = 8,        ///< tumble in steps of 30 degrees
  kSupply = 16,      ///< steps of the electrode supply
  kTrim = 32,        ///< offsets on the quadrature command
  kPower = 64,       ///< switched off and on again
  kBoardLoad = 128,  ///< the electronics' own load changes: board apart from case
  kRich = kTurn | kSteps | kTumble | kSupply | kTrim
};

/// Chamber programs.
inline const std::vector<std::string> kFullPrograms = {"cycle", "multispeed", "soak", "random"};
inline const std::vector<std::string> kPoorPrograms = {"ramp", "slow_ramp", "constant"};

/// The inputs of one recording, noise-free, one value a second.
struct Excitation {
  std::string program{};
  unsigned stimuli = 0;
  Series time_s{};
  Series case_degc{};        ///< at time_s
  Series case_ahead_degc{};  ///< half a sample later, less the instrument's sub-sample lag
  Series board_degc{};
  Series rate_in_dph{};
  Series accel_g{};
  Series supply_v{};
  Series trim_v{};
  Series amplitude{};  ///< set point as commanded
  Series power{};      ///< 1 on, 0 off: nothing is recorded
};

/// A chamber run of 5 to 10 h; `program` is one of the names above, `stimuli` a set of Stimulus.
Excitation random_excitation(Random& random, const Instrument& unit, const std::string& program,
                             unsigned stimuli);

/// The series read `seconds` later (negative: earlier), straight lines between samples and for at
/// most one second beyond the ends.
Series later(const Series& values, double seconds);

/// First-order lag of a series that runs linearly from sample to sample (1 s): exact.
Series lagged(const Series& input, double time_constant_s, double start);

}  // namespace hemi::concealed

// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_CLI_PROVE_EXPERIMENT_HPP
#define HEMI_CLI_PROVE_EXPERIMENT_HPP

#include <optional>
#include <string>

#include "golden/concealed/cases.hpp"

namespace hemi::prove {

/// The scenario file that an ambiguous answer proposes: a path ending in .toml in `separating_experiment` of
/// its first alternative that has one, relative to the answer's directory. Empty where there is none.
std::string proposed_scenario(const std::string& answer_directory);

/// The inputs of a recorded run as a run of one of the writer's own instruments, averaged to one-second steps
/// where they are finer: the case thermometer smoothed over a minute, the supply in units of its first value
/// times 150 V. The board is the instrument's: its lag and rise over this case, and what the run's own board
/// has moved by against its case since the start (a heater). Nothing where the file lacks the case
/// thermometer or is shorter than half an hour. InputError.
std::optional<concealed::Excitation> inputs_of(const std::string& recording_path,
                                               const concealed::Instrument& unit);

}  // namespace hemi::prove

#endif  // HEMI_CLI_PROVE_EXPERIMENT_HPP

// SPDX-License-Identifier: Apache-2.0
// Cores with a fault: a register that holds another value than the design's, or a line of the core that was
// changed.
#ifndef HEMI_TESTS_CLI_STAGE_CORE_FAULTS_HPP
#define HEMI_TESTS_CLI_STAGE_CORE_FAULTS_HPP

#include <memory>
#include <string>

#include "tb/engine.hpp"

namespace hemi::tests {

/// Breaks registers (which < 0.6) or replaces the engine by a changed one; returns what was done. `strength`
/// 0..1: relative change of a register, 1e-3 to 0.3, or, in a third of the cases, one flipped bit.
std::string break_core(double which, double strength, tb::RegisterValues& registers,
                       std::unique_ptr<tb::Engine>& engine);

}  // namespace hemi::tests

#endif  // HEMI_TESTS_CLI_STAGE_CORE_FAULTS_HPP

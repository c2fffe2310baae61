// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TESTS_TB_MUTANT_ENGINE_HPP
#define HEMI_TESTS_TB_MUTANT_ENGINE_HPP

#include <memory>

#include "tb/engine.hpp"

namespace hemi::tests {

/// The engine under test, reference instrument; defined by the file that is compiled against the mutated
/// sources.
std::unique_ptr<tb::Engine> make_mutant_engine();

}  // namespace hemi::tests

#endif  // HEMI_TESTS_TB_MUTANT_ENGINE_HPP

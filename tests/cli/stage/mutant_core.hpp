// SPDX-License-Identifier: Apache-2.0
// A core whose sources were changed in one line, behind an interface that shares nothing with them.
#ifndef HEMI_TESTS_CLI_STAGE_MUTANT_CORE_HPP
#define HEMI_TESTS_CLI_STAGE_MUTANT_CORE_HPP

#include <cstdint>
#include <memory>
#include <vector>

namespace hemi_tests_mutant {

class Core {
 public:
  virtual ~Core() = default;
  virtual void reset(const std::int64_t* registers) = 0;
  /// True when `words` holds a record.
  virtual bool step(std::int32_t x, std::int32_t y, std::int64_t* words, std::int32_t* dacs) = 0;
};

struct Mutant {
  const char* change;
  const char* block;
  std::unique_ptr<Core> (*make)();
};

}  // namespace hemi_tests_mutant

namespace hemi::tests {

using MutantCore = hemi_tests_mutant::Core;
using Mutant = hemi_tests_mutant::Mutant;

/// In the order of core_mutations.txt; generated.
const std::vector<Mutant>& mutants();

}  // namespace hemi::tests

#endif  // HEMI_TESTS_CLI_STAGE_MUTANT_CORE_HPP

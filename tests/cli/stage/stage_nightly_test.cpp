// SPDX-License-Identifier: Apache-2.0
// 160 concealed captures, twenty a class, from weak to strong; and as many with nothing wrong.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/cli/stage/matrix.hpp"

namespace hemi::tests {
namespace {

TEST(StageNightly, PutsAtLeast95PercentIntoTheRightStage) {
  const char* fresh = std::getenv("HEMI_STAGE_SEED");
  const std::uint64_t first = fresh != nullptr ? std::strtoull(fresh, nullptr, 10) : 20000;
  constexpr int each = 20;
  Matrix matrix;
  for (int k = 0; k < each; ++k)
    for (int f = 0; f < fault_count; ++f)
      matrix.run(static_cast<Fault>(f), (k + 0.5) / each,
                 first + static_cast<std::uint64_t>(k * fault_count + f), 1.5);
  matrix.print();
  const Score all = matrix.score(true);
  const auto interval = all.wilson();
  fmt::print("{} of {} in the right stage, {:.1f} % (95 %: {:.1f} to {:.1f} %)\n", all.right, all.total,
             100.0 * all.right / all.total, 100.0 * interval[0], 100.0 * interval[1]);
  EXPECT_GE(all.right, 0.95 * all.total);
}

TEST(StageNightly, FindsNothingWhereNothingIsWrong) {
  constexpr int captures = 100;
  Matrix matrix;
  for (int k = 0; k < captures; ++k) matrix.run(Fault::none, 0.0, 40000 + static_cast<std::uint64_t>(k), 1.5);
  const int quiet = matrix.count[0][0];
  fmt::print("{} of {} without a finding\n", quiet, captures);
  // One false alarm in a hundred is what the tests are set to: more than five of a hundred has a chance of
  // 5e-4.
  EXPECT_GE(quiet, captures - 5);
}

}  // namespace
}  // namespace hemi::tests

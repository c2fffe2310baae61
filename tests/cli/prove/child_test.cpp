// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/child.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/cli/recording/scratch.hpp"

namespace hemi::prove {
namespace {

class Child : public recording::testing::ScratchTest {
 protected:
  ChildResult shell(const std::string& script, const ChildLimits& limits = {20.0, 0.0}) const {
    return run_child("/bin/sh", {"-c", script}, path("log"), limits);
  }
};

TEST_F(Child, EndsWellWithZeroAndOne) {
  EXPECT_EQ(shell("exit 0").failure, "");
  EXPECT_EQ(shell("exit 1").failure, "");
}

TEST_F(Child, TellsWhatItSaidLast) {
  const auto result = shell("echo first >&2; echo 'no such file' >&2; exit 2");
  EXPECT_NE(result.failure.find("exit code 2"), std::string::npos) << result.failure;
  EXPECT_NE(result.failure.find("no such file"), std::string::npos) << result.failure;
}

TEST_F(Child, TellsACrash) {
  EXPECT_EQ(shell("kill -SEGV $$").failure, "ended by signal 11");
}

TEST_F(Child, IsEndedAtItsLimitWithAllItStarted) {
  const auto begin = std::chrono::steady_clock::now();
  const auto result = shell("sleep 60 & sleep 60", {0.2, 0.0});
  EXPECT_NE(result.failure.find("within 0.2 s"), std::string::npos) << result.failure;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST_F(Child, SaysWhatItUsed) {
  const auto result = shell("x=$(head -c 60000000 /dev/zero | tr '\\0' a); exit 0");
  EXPECT_EQ(result.failure, "");
  EXPECT_GT(result.peak_mib, 50.0);
}

TEST_F(Child, ThatIsNoProgramIsAFailure) {
  EXPECT_NE(run_child("/nonexistent", {}, path("log"), {5.0, 0.0}).failure, "");
}

}  // namespace
}  // namespace hemi::prove

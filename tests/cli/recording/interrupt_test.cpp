// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/interrupt.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "cli/recording/partial_file.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

class Interrupt : public ScratchTest {
 protected:
  // Runs `work` in a child, sends the signal once NAME.partial is there, and returns the child's exit code.
  // `repeated`: sends it until the child ends (signals that are pending together arrive as one).
  int exit_code_after(const std::function<int()>& work, int signal, bool repeated) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(work());
    const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
    for (int tries = 0; tries < 500 && !std::filesystem::exists(path("a.csv.partial")); ++tries) wait();
    EXPECT_TRUE(std::filesystem::exists(path("a.csv.partial")));
    ::kill(child, signal);
    int status = 0;
    for (int tries = 0; ::waitpid(child, &status, WNOHANG) == 0; ++tries) {
      wait();
      if (repeated) ::kill(child, signal);
      if (tries == 1500) ::kill(child, SIGKILL);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

// A loop as the program has them: it looks at the flag, the exception unwinds, main returns the code.
TEST_F(Interrupt, FirstSignalUnwindsAndRemovesThePartialFile) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto work = [this] {
      install_interrupt_handler();
      try {
        PartialFile partial(path("a.csv"));
        for (;;) partial.write("0123456789");
      } catch (const Interrupted&) {
        return kInterruptedExitCode;
      }
    };
    EXPECT_EQ(exit_code_after(work, signal, false), 130);
    EXPECT_TRUE(names().empty());
  }
}

// A computation that never looks at the flag.
TEST_F(Interrupt, SecondSignalEndsAtOnceAndRemovesThePartialFile) {
  const auto work = [this]() -> int {
    install_interrupt_handler();
    PartialFile partial(path("a.csv"));
    partial.write("abc");
    for (;;) ::pause();
  };
  EXPECT_EQ(exit_code_after(work, SIGINT, true), 130);
  EXPECT_TRUE(names().empty());
}

TEST_F(Interrupt, WithoutSignalNothingHappens) {
  EXPECT_FALSE(interrupted());
  EXPECT_NO_THROW(check_interrupt());
}

}  // namespace
}  // namespace hemi::recording::testing

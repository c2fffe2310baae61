// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/progress.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <array>

namespace hemi::recording {
namespace {

TEST(Progress, Line) {
  EXPECT_EQ(progress_line("reading", 0.0, 3.0), "reading  0 %");
  // A quarter in 30 s leaves 90 s.
  EXPECT_EQ(progress_line("reading", 0.25, 30.0), "reading  25 %, 1:30 left");
  // A thousandth in 10 s leaves 9990 s.
  EXPECT_EQ(progress_line("reading", 0.001, 10.0), "reading  0 %, 2:46:30 left");
  EXPECT_EQ(progress_line("reading", 1.5, 10.0), "reading  100 %, 0:00 left");
}

std::string everything_from(int descriptor) {
  ::fcntl(descriptor, F_SETFL, O_NONBLOCK);
  std::array<char, 4096> buffer{};
  const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
  return count > 0 ? std::string(buffer.data(), static_cast<std::size_t>(count)) : "";
}

TEST(Progress, TerminalGetsALineAfterTwoSeconds) {
  int master = -1;
  int terminal = -1;
  if (::openpty(&master, &terminal, nullptr, nullptr, nullptr) != 0)
    GTEST_SKIP() << "no pseudo-terminals here";
  double now_s = 100.0;
  {
    Progress progress("work", 10.0, terminal, [&now_s] { return now_s; });
    now_s = 101.9;
    progress.update(2.0);
    EXPECT_EQ(everything_from(master), "");
    now_s = 104.0;
    progress.update(4.0);
    EXPECT_EQ(everything_from(master), "\r\x1b[Kwork  40 %, 0:06 left");
    now_s = 104.05;  // not more often than ten times a second
    progress.update(5.0);
    EXPECT_EQ(everything_from(master), "");
  }
  EXPECT_EQ(everything_from(master), "\r\x1b[K");
  ::close(master);
  ::close(terminal);
}

TEST(Progress, PipeGetsNothing) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  double now_s = 0.0;
  {
    Progress progress("work", 10.0, ends[1], [&now_s] { return now_s; });
    now_s = 60.0;
    progress.update(4.0);
  }
  EXPECT_EQ(everything_from(ends[0]), "");
  ::close(ends[0]);
  ::close(ends[1]);
}

}  // namespace
}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <system_error>
#include <thread>

#include "cli/recording/interrupt.hpp"

namespace hemi::prove {
namespace {

/// After fork() in a program with threads: system calls alone.
[[noreturn]] void become(const char* program, char* const* arguments, const char* log, rlim_t address_space) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (address_space > 0) {
    const rlimit limit{address_space, address_space};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  const int nothing = ::open("/dev/null", O_RDWR);
  const int errors = ::open(log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  ::dup2(nothing, 0);
  ::dup2(nothing, 1);
  ::dup2(errors, 2);
  ::execv(program, arguments);
  ::_exit(127);
}

std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string line, last;
  while (std::getline(file, line))
    if (!line.empty()) last = line;
  return last.substr(0, 200);
}

}  // namespace

ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments,
                      const std::string& log, const ChildLimits& limits) {
  using Clock = std::chrono::steady_clock;
  std::vector<char*> pointers{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  const auto address_space = static_cast<rlim_t>(limits.memory_mib * 1048576.0);
  const auto begin = Clock::now();
  const auto elapsed_s = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const pid_t child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) become(program.c_str(), pointers.data(), log.c_str(), address_space);
  int status = 0;
  rusage usage{};
  bool late = false;
  while (true) {
    const pid_t done = ::wait4(child, &status, WNOHANG, &usage);
    if (done == child) break;
    if (done < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "wait4");
    if (recording::interrupted()) {
      ::kill(-child, SIGKILL);
      ::wait4(child, &status, 0, &usage);
      throw recording::Interrupted();
    }
    if (!late && elapsed_s() > limits.seconds) {
      late = true;
      ::kill(-child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ChildResult result;
  result.seconds = elapsed_s();
  result.peak_mib = static_cast<double>(usage.ru_maxrss) / 1024.0;
  if (late)
    result.failure = fmt::format("no answer within {:g} s", limits.seconds);
  else if (WIFSIGNALED(status))
    result.failure = fmt::format("ended by signal {}", WTERMSIG(status));
  else if (WEXITSTATUS(status) > 1)
    result.failure = fmt::format("exit code {} {}", WEXITSTATUS(status), last_line(log));
  return result;
}

}  // namespace hemi::prove

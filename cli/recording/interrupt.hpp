// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace hemi::recording {

/// Exit code of a program that SIGINT or SIGTERM ended.
inline constexpr int kInterruptedExitCode = 130;

/// Thrown by check_interrupt(); unwinding removes the partial files. main() returns kInterruptedExitCode.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// From now on SIGINT and SIGTERM set a flag. A second signal ends the process at once with
/// kInterruptedExitCode, after removing the partial files that are registered.
void install_interrupt_handler();

/// True since the first signal.
bool interrupted();

/// Throws Interrupted since the first signal. Cheap: call it once a block in every long loop.
void check_interrupt();

/// Keeps a path on the list of files that the second signal removes, for as long as the object lives.
class RemovedOnSignal {
 public:
  explicit RemovedOnSignal(const std::string& path);
  ~RemovedOnSignal();
  RemovedOnSignal(const RemovedOnSignal&) = delete;
  RemovedOnSignal& operator=(const RemovedOnSignal&) = delete;

 private:
  int slot_ = -1;
};

}  // namespace hemi::recording

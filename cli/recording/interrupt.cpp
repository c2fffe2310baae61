// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/interrupt.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <csignal>
#include <cstddef>
#include <cstring>

namespace hemi::recording {
namespace {

// A signal handler may touch neither the heap nor a mutex: the list is a fixed table with a state a slot.
enum class SlotState : int { kFree, kFilling, kSet };

struct Slot {
  std::atomic<SlotState> state{SlotState::kFree};
  std::array<char, PATH_MAX> path{};
};

constexpr std::size_t kSlots = 16;
constinit std::array<Slot, kSlots> slots{};
constinit std::atomic<bool> flag{false};
static_assert(std::atomic<SlotState>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

extern "C" void on_signal(int) {
  if (!flag.exchange(true)) return;
  for (const Slot& slot : slots) {
    if (slot.state.load() == SlotState::kSet) ::unlink(slot.path.data());
  }
  ::_exit(kInterruptedExitCode);
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() {
  return flag.load(std::memory_order_relaxed);
}

void check_interrupt() {
  if (interrupted()) throw Interrupted();
}

RemovedOnSignal::RemovedOnSignal(const std::string& path) {
  if (path.size() >= PATH_MAX) return;
  for (std::size_t i = 0; i < kSlots; ++i) {
    auto expected = SlotState::kFree;
    if (!slots[i].state.compare_exchange_strong(expected, SlotState::kFilling)) continue;
    std::memcpy(slots[i].path.data(), path.c_str(), path.size() + 1);
    slots[i].state.store(SlotState::kSet);
    slot_ = static_cast<int>(i);
    return;
  }
}

RemovedOnSignal::~RemovedOnSignal() {
  if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].state.store(SlotState::kFree);
}

}  // namespace hemi::recording

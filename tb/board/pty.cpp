// SPDX-License-Identifier: Apache-2.0
#include "tb/board/pty.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

namespace hemi::tb {
namespace {

[[noreturn]] void refuse(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

Pty::Pty() : descriptor_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
  if (descriptor_ < 0 || grantpt(descriptor_) != 0 || unlockpt(descriptor_) != 0) refuse("pseudo-terminal");
  std::array<char, 128> name{};
  if (ptsname_r(descriptor_, name.data(), name.size()) != 0) refuse("pseudo-terminal");
  name_ = name.data();
  termios line{};
  if (tcgetattr(descriptor_, &line) != 0) refuse("pseudo-terminal");
  cfmakeraw(&line);
  if (tcsetattr(descriptor_, TCSANOW, &line) != 0) refuse("pseudo-terminal");
  // Until the other end has been opened once, Linux does not say that nobody has it.
  const int other = open(name_.c_str(), O_RDWR | O_NOCTTY);
  if (other < 0) refuse("pseudo-terminal");
  close(other);
}

Pty::~Pty() {
  close(descriptor_);
}

bool Pty::connected(int wait_ms) {
  pollfd here{descriptor_, POLLIN, 0};
  poll(&here, 1, 0);
  if ((here.revents & POLLHUP) == 0) return true;
  if (wait_ms > 0) std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
  poll(&here, 1, 0);
  return (here.revents & POLLHUP) == 0;
}

std::vector<std::uint8_t> Pty::read() {
  std::vector<std::uint8_t> bytes(4096);
  const ssize_t n = ::read(descriptor_, bytes.data(), bytes.size());
  bytes.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  return bytes;
}

void Pty::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(n));
      continue;
    }
    if (n < 0 && errno != EAGAIN && errno != EINTR) return;
    if (!connected(0)) return;
    pollfd here{descriptor_, POLLOUT, 0};
    poll(&here, 1, 10);
  }
}

}  // namespace hemi::tb

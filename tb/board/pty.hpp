// SPDX-License-Identifier: Apache-2.0
// A pseudo-terminal as a serial line: this program has one end, the other has a name that a host opens.
#ifndef HEMI_TB_BOARD_PTY_HPP
#define HEMI_TB_BOARD_PTY_HPP

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hemi::tb {

/// Raw, nothing echoed. Throws std::system_error where the system refuses.
class Pty {
 public:
  Pty();
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  const std::string& name() const { return name_; }
  /// A host has the other end open; waits for it up to `wait_ms`.
  bool connected(int wait_ms);
  /// What the host has written since.
  std::vector<std::uint8_t> read();
  /// Waits while the host does not take it; without a host the bytes are lost, as on a line.
  void write(std::span<const std::uint8_t> bytes);

 private:
  int descriptor_ = -1;
  std::string name_;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_BOARD_PTY_HPP

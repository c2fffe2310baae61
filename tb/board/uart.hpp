// SPDX-License-Identifier: Apache-2.0
// The host's end of a serial line, one clock of the board at a time: eight bits, no parity, one stop bit.
#ifndef HEMI_TB_BOARD_UART_HPP
#define HEMI_TB_BOARD_UART_HPP

#include <cstdint>
#include <deque>
#include <optional>
#include <stdexcept>

namespace hemi::tb {

/// Sends the bytes that wait, back to back. `bit_clocks`: the host's own idea of a bit's length in board
/// clocks.
class UartSender {
 public:
  explicit UartSender(double bit_clocks) : bit_clocks_(bit_clocks) {}
  void send(std::uint8_t byte) { bytes_.push_back(byte); }
  bool idle() const { return bytes_.empty() && bit_ == rest; }

  /// The line at the next clock.
  bool clock() {
    if (bit_ == rest) {
      if (bytes_.empty()) return true;
      frame_ = 0x200U | static_cast<unsigned>(bytes_.front()) << 1;
      bytes_.pop_front();
      bit_ = 0;
      time_ = 0;
    }
    const bool level = (frame_ >> bit_ & 1) != 0;
    if (++time_ >= bit_clocks_) {
      time_ -= bit_clocks_;
      ++bit_;
    }
    return level;
  }

 private:
  static constexpr int rest = 10;
  double bit_clocks_;
  std::deque<std::uint8_t> bytes_;
  unsigned frame_ = 0;
  int bit_ = rest;
  double time_ = 0;
};

/// Reads each bit in its middle; throws std::runtime_error where a stop bit is missing.
class UartReceiver {
 public:
  explicit UartReceiver(double bit_clocks) : bit_clocks_(bit_clocks) {}

  std::optional<std::uint8_t> clock(bool level) {
    if (bit_ == rest) {
      if (level) return std::nullopt;
      bit_ = 0;
      time_ = 0.5 * bit_clocks_;
      frame_ = 0;
    }
    if (++time_ < bit_clocks_) return std::nullopt;
    time_ -= bit_clocks_;
    frame_ |= static_cast<unsigned>(level) << bit_;
    if (bit_ == 0 && level) throw std::runtime_error("board: a spike on the serial line");
    if (++bit_ < rest) return std::nullopt;
    if (!level) throw std::runtime_error("board: a byte without its stop bit");
    return static_cast<std::uint8_t>(frame_ >> 1);
  }

 private:
  static constexpr int rest = 10;
  double bit_clocks_;
  unsigned frame_ = 0;
  int bit_ = rest;
  double time_ = 0;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_BOARD_UART_HPP

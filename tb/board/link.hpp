// SPDX-License-Identifier: Apache-2.0
// The host's side of the board's serial link: bytes to frames and back (docs/board.md).
#ifndef HEMI_TB_BOARD_LINK_HPP
#define HEMI_TB_BOARD_LINK_HPP

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "rtl/address_map.hpp"

namespace hemi::tb {

/// What came from the board: a record, or the answer to a request.
struct LinkFrame {
  bool record = false;
  std::uint8_t code = 0;  ///< sequence number of a record, modulo 256; response code of an answer
  std::uint8_t address = 0;
  std::vector<std::int64_t> words;  ///< sign-extended: config::record_words of them, or one
};

/// CRC of a frame's bytes as it follows them, low byte first.
std::uint16_t link_crc(std::span<const std::uint8_t> bytes);

/// A request: reads `address`, or writes the low 54 bits of `data` to it.
std::vector<std::uint8_t> link_request(bool write, std::uint8_t address, std::int64_t data);

/// Finds frames in a stream of bytes. After an error on the line it begins again at the next header that a
/// good CRC follows.
class LinkDecoder {
 public:
  void push(std::uint8_t byte) { bytes_.push_back(byte); }
  /// The next whole frame, if there is one.
  std::optional<LinkFrame> next();
  /// The line is silent: what was begun will not be finished. Frames behind its first byte come from next().
  void give_up() {
    if (!bytes_.empty()) drop();
  }
  /// Bytes that belonged to no frame.
  std::uint64_t dropped() const { return dropped_; }

 private:
  void drop() {
    bytes_.pop_front();
    ++dropped_;
  }

  std::deque<std::uint8_t> bytes_;
  std::uint64_t dropped_ = 0;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_BOARD_LINK_HPP

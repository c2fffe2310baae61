// SPDX-License-Identifier: Apache-2.0
#include "tb/board/link.hpp"

#include <algorithm>
#include <boost/crc.hpp>

namespace hemi::tb {
namespace {

constexpr int crc_bytes = 2;
constexpr std::size_t words_at = 3;

std::int64_t word_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t word = 0;
  for (int i = 0; i < board::word_bytes; ++i) word |= std::uint64_t{bytes[i]} << (8 * i);
  constexpr int unused = 64 - 8 * board::word_bytes;
  return static_cast<std::int64_t>(word << unused) >> unused;
}

}  // namespace

std::uint16_t link_crc(std::span<const std::uint8_t> bytes) {
  boost::crc_optimal<16, 0x1021, 0xffff, 0xffff, true, true> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return static_cast<std::uint16_t>(crc.checksum());
}

std::vector<std::uint8_t> link_request(bool write, std::uint8_t address, std::int64_t data) {
  const int command = write ? board::write_command : board::read_command;
  std::vector<std::uint8_t> bytes = {board::request_header, static_cast<std::uint8_t>(command), address};
  for (int i = 0; i < board::word_bytes; ++i) bytes.push_back(static_cast<std::uint8_t>(data >> (8 * i)));
  const std::uint16_t crc = link_crc(bytes);
  bytes.push_back(static_cast<std::uint8_t>(crc));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  return bytes;
}

std::optional<LinkFrame> LinkDecoder::next() {
  for (; !bytes_.empty(); drop()) {
    const bool record = bytes_[0] == board::record_header;
    if (!record && bytes_[0] != board::response_header) continue;
    const std::size_t words = record ? std::size_t{config::record_words} : 1;
    const std::size_t size = words_at + words * board::word_bytes + crc_bytes;
    if (bytes_.size() < size) return std::nullopt;
    const std::vector<std::uint8_t> frame(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size));
    const std::uint16_t crc = link_crc(std::span(frame).first(size - crc_bytes));
    if (frame[size - 2] != (crc & 0xff) || frame[size - 1] != crc >> 8) continue;
    LinkFrame found{record, frame[1], frame[2], {}};
    for (std::size_t i = 0; i < words; ++i)
      found.words.push_back(word_of(std::span(frame).subspan(words_at + i * board::word_bytes)));
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size));
    return found;
  }
  return std::nullopt;
}

}  // namespace hemi::tb

// SPDX-License-Identifier: Apache-2.0
// What a host does with the board over its serial link, whatever carries the bytes.
#ifndef HEMI_TB_BOARD_HOST_HPP
#define HEMI_TB_BOARD_HOST_HPP

#include <cstdint>
#include <deque>
#include <span>
#include <stdexcept>
#include <vector>

#include "tb/board/link.hpp"
#include "tb/engine.hpp"

namespace hemi::tb {

/// Carries bytes to the board and back.
class LinkPort {
 public:
  virtual ~LinkPort() = default;
  virtual void write(std::span<const std::uint8_t> bytes) = 0;
  /// What has come since; waits for the first byte as long as a board could take. Empty: nothing came.
  virtual std::vector<std::uint8_t> read() = 0;
};

/// The board does not answer, is no board of this kind, or lost something.
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class BoardHost {
 public:
  explicit BoardHost(LinkPort& port) : port_(port) {}

  /// Address of board::addresses, or below it of a register. A request that stays without an answer is sent
  /// again twice; LinkError after that, and where the board refuses.
  std::int64_t read(int address) { return request(false, address, 0); }
  void write(int address, std::int64_t data);

  /// LinkError unless a board with this core answers.
  void identify();
  /// Stops it, resets the core, loads all registers, looks whether they are there, clears the faults, starts.
  void start(const RegisterImage& image);
  void stop() { write(control_, 0); }
  /// The next record; LinkError where one is missing or none comes.
  Record record();
  /// board::Fault bits since the start.
  int faults() { return static_cast<int>(read(faults_)); }

 private:
  static constexpr int identity_ = board::addresses[0].address;
  static constexpr int shape_ = board::addresses[1].address;
  static constexpr int control_ = board::addresses[2].address;
  static constexpr int faults_ = board::addresses[3].address;

  std::int64_t request(bool write, int address, std::int64_t data);
  /// True when an answer to `address` came: `answer`. False: silence.
  bool wait_for_answer(int address, LinkFrame& answer);
  /// Takes in what has come; false: silence.
  bool receive();

  LinkPort& port_;
  LinkDecoder decoder_;
  std::deque<LinkFrame> records_;
  std::uint8_t next_number_ = 0;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_BOARD_HOST_HPP

// SPDX-License-Identifier: Apache-2.0
#include "tb/board/host.hpp"

#include <fmt/format.h>

#include "tb/registers.hpp"

namespace hemi::tb {

bool BoardHost::receive() {
  const std::vector<std::uint8_t> bytes = port_.read();
  for (const std::uint8_t byte : bytes) decoder_.push(byte);
  if (bytes.empty()) decoder_.give_up();
  return !bytes.empty();
}

bool BoardHost::wait_for_answer(int address, LinkFrame& answer) {
  do {
    while (auto frame = decoder_.next()) {
      if (frame->record) {
        records_.push_back(std::move(*frame));
      } else if (frame->address == address) {
        answer = std::move(*frame);
        return true;
      }
    }
  } while (receive());
  return false;
}

std::int64_t BoardHost::request(bool write, int address, std::int64_t data) {
  constexpr int attempts = 3;
  const auto bytes = link_request(write, static_cast<std::uint8_t>(address), data);
  LinkFrame answer;
  for (int i = 0; i < attempts; ++i) {
    port_.write(bytes);
    if (!wait_for_answer(address, answer)) continue;
    if (answer.code == board::done) return answer.words[0];
    throw LinkError(
        fmt::format("the board refuses to {} address 0x{:02x}", write ? "write" : "read", address));
  }
  throw LinkError("the board does not answer");
}

void BoardHost::write(int address, std::int64_t data) {
  request(true, address, data);
}

void BoardHost::identify() {
  if (read(identity_) != board::identity_word) throw LinkError("what answers is no hemi board");
  constexpr std::int64_t shape = config::Reference::adc_bits << 24 | config::Reference::decimation << 16 |
                                 config::record_words << 8 | first_state_address;
  if (const std::int64_t found = read(shape_); found != shape)
    throw LinkError(
        fmt::format("the board's core has the shape {:08x}, this program knows {:08x}", found, shape));
}

void BoardHost::start(const RegisterImage& image) {
  stop();
  write(control_, board::control_reset);
  records_.clear();
  for (int i = 0; i < config::register_count; ++i) {
    write(i, image[i]);
    if (read(i) != image[i])
      throw LinkError(fmt::format("register {} does not hold what was written", config::registers[i].name));
  }
  write(faults_, board::fault_sample_lost | board::fault_words_late | board::fault_bad_request |
                     board::fault_request_lost);
  next_number_ = 0;
  write(control_, board::control_run);
}

Record BoardHost::record() {
  while (records_.empty()) {
    while (auto frame = decoder_.next()) {
      if (frame->record) records_.push_back(std::move(*frame));
    }
    if (records_.empty() && !receive()) throw LinkError("no record comes");
  }
  const LinkFrame frame = std::move(records_.front());
  records_.pop_front();
  if (frame.code != next_number_)
    throw LinkError(fmt::format("record {} comes where {} was due", frame.code, next_number_));
  ++next_number_;
  return to_record(frame.words);
}

}  // namespace hemi::tb

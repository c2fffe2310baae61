// SPDX-License-Identifier: Apache-2.0
// What software sees behind hemi_axi's AXI4-Lite port, written from docs/fpga.md.
#ifndef HEMI_TESTS_RTL_AXI_AXI_MODEL_HPP
#define HEMI_TESTS_RTL_AXI_AXI_MODEL_HPP

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "hls/config.hpp"
#include "rtl/address_map.hpp"

namespace hemi::tests {

enum class Response : std::uint8_t { okay = 0, slave_error = 2, decode_error = 3 };

class AxiModel {
 public:
  static constexpr std::uint32_t record_base = 0x200, identity = 0x300, shape = 0x304,
                                 interrupt_enable = 0x308, interrupt_pending = 0x30c, fault_mask = 0x310,
                                 record_count = 0x314, live_status = 0x318;
  static_assert(8 * first_state_address <= record_base, "registers end below the record");

  using RecordWords = std::array<std::int64_t, config::record_words>;

  static bool is_register(std::uint32_t address) { return address < 8 * first_state_address; }
  static bool is_record(std::uint32_t address) {
    return address >= record_base && address < record_base + 8 * config::record_words;
  }
  static bool is_control(std::uint32_t address) { return address >= identity && address < live_status + 4; }

  static Response decode(std::uint32_t address) {
    if (address % 4 != 0) return Response::slave_error;
    const bool mapped = is_register(address) || is_record(address) || is_control(address);
    return mapped ? Response::okay : Response::decode_error;
  }

  std::uint32_t read(std::uint32_t address) const {
    if (decode(address) != Response::okay) return 0;
    if (is_register(address)) return half(registers_[address / 8], address);
    if (is_record(address)) return half(record_[(address - record_base) / 8], address);
    switch (address) {
      case identity:
        return 0x48454d49;
      case shape:
        return config::Reference::adc_bits << 24 | config::Reference::decimation << 16 |
               config::record_words << 8 | first_state_address;
      case interrupt_enable:
        return enable_;
      case interrupt_pending:
        return pending_;
      case fault_mask:
        return mask_;
      case record_count:
        return count_;
      default:
        return live_;
    }
  }

  Response write(std::uint32_t address, std::uint32_t data, unsigned strobe) {
    const Response decoded = decode(address);
    if (decoded != Response::okay) return decoded;
    if (strobe != 15) return Response::slave_error;
    if (is_register(address)) return write_half(address, data);
    switch (address) {
      case interrupt_enable:
        enable_ = data & 3;
        return Response::okay;
      case interrupt_pending:
        pending_ &= ~data;
        return Response::okay;
      case fault_mask:
        mask_ = data & live_bits;
        return Response::okay;
      default:
        return Response::slave_error;
    }
  }

  /// A record was taken while the fault mask was `mask`.
  void record(const RecordWords& words, std::uint32_t mask) {
    record_ = words;
    live_ = static_cast<std::uint32_t>(words[config::word_status]) & live_bits;
    ++count_;
    pending_ |= (live_ & mask) != 0 ? 3 : 1;
  }

  std::uint32_t mask() const { return mask_; }
  bool interrupt() const { return (pending_ & enable_) != 0; }

 private:
  static constexpr std::uint32_t live_bits = (std::uint32_t{1} << config::status_bits) - 1;

  static std::uint32_t half(std::int64_t word, std::uint32_t address) {
    return static_cast<std::uint32_t>(word >> (address & 4 ? 32 : 0));
  }

  Response write_half(std::uint32_t address, std::uint32_t data) {
    const std::uint32_t index = address / 8;
    if ((address & 4) == 0) {
      low_ = {index, data};
      return Response::okay;
    }
    if (!low_ || low_->first != index) return Response::slave_error;
    const std::uint64_t word = static_cast<std::uint64_t>(data) << 32 | low_->second;
    registers_[index] = static_cast<std::int64_t>(word << 10) >> 10;  // 54 bits
    low_.reset();
    return Response::okay;
  }

  std::array<std::int64_t, first_state_address> registers_{};
  RecordWords record_{};
  std::optional<std::pair<std::uint32_t, std::uint32_t>> low_;
  std::uint32_t enable_ = 0, pending_ = 0, mask_ = 0, count_ = 0, live_ = 0;
};

}  // namespace hemi::tests

#endif  // HEMI_TESTS_RTL_AXI_AXI_MODEL_HPP

// SPDX-License-Identifier: Apache-2.0
// Where things are: addresses of the core's register port, of hemi_axi and of the board's serial link. The
// packages rtl/axi/hemi_axi_pkg.sv and rtl/board/hemi_board_pkg.sv, the C header and docs/registers.md are
// written from this file and hls/config.hpp by hemi_registers.
#ifndef HEMI_RTL_ADDRESS_MAP_HPP
#define HEMI_RTL_ADDRESS_MAP_HPP

#include <cstdint>

#include "hls/config.hpp"

namespace hemi {

// The register port: the registers in the order of config::RegisterIndex, then telemetry.
constexpr int telemetry_frequency_address = config::register_count;  ///< of the next telemetry sample
constexpr int telemetry_rate_address = telemetry_frequency_address + 1;
constexpr int first_state_address = telemetry_rate_address + 1;  ///< from here on the port writes nothing

constexpr int word_bits = 54;  ///< of the register port and of a record's words

/// The words of a record, in the order of config::RecordWord.
constexpr config::Register record_layout[config::record_words] = {
    {"frequency", config::frequency, "Hz", "mean over two output intervals, nominal Hz"},
    {"temperature", config::temperature, "degC", "from the frequency"},
    {"derivative", config::derivative, "full scale", "df/dt over its programmable full scale"},
    {"amplitude", config::amplitude_sum, "1", "sum over 50 ticks"},
    {"phase_error", config::phase_error_sum, "turns", "sum over 50 ticks"},
    {"drive", config::command_sum, "full scale", "command, sum over 50 ticks"},
    {"quadrature", config::command_sum, "full scale", "command, sum over 50 ticks"},
    {"bias", config::bias, "deg/h", "of the model"},
    {"rate", config::rate, "deg/h", "as measured"},
    {"compensated", config::rate, "deg/h", "rate less bias, over the scale factor"},
    {"status", config::status, "bits", "live bits from 0, sticky bits from 24 on"},
};

/// One address beside those of the registers.
struct NamedAddress {
  const char* name;
  int address;
  const char* access;
  const char* meaning;
};

// ---- hemi_axi: byte addresses; register i at 8 i (low half) and 8 i + 4 (high half)
namespace axi {

constexpr int address_bits = 12;
constexpr int dac_lane_bits = 16;
constexpr int store_bits = 7;
constexpr int record_base = 0x200;  ///< word i of the last whole record at record_base + 8 i
constexpr std::uint32_t identity_word = 0x48454d49;
constexpr NamedAddress addresses[] = {
    {"identity", 0x300, "r", "\"HEMI\", 0x48454d49"},
    {"shape", 0x304, "r", "ADC bits, decimation, record words, registers: a byte each, from the top"},
    {"interrupt_enable", 0x308, "rw", "bit 0 record, bit 1 fault"},
    {"interrupt_pending", 0x30c, "rw1c", "the same bits; writing 1 clears"},
    {"fault_mask", 0x310, "rw", "live status bits that raise the fault interrupt"},
    {"record_count", 0x314, "r", "records since reset"},
    {"live_status", 0x318, "r", "live status bits of the last record"},
};

}  // namespace axi

// ---- The board: its clock and its serial link; an address is one word of 54 bits, register i at i
namespace board {

constexpr int clock_hz = 24000000;
constexpr int sample_clocks = clock_hz / config::Reference::adc_rate_hz;
constexpr int conversion_clocks = 44;  ///< CNV high: 1.83 us, the ADCs need 1.6 us
constexpr int baud = 1000000;
constexpr int baud_clocks = clock_hz / baud;
static_assert(conversion_clocks % 2 == 0, "the bits of a reading begin at even clocks");
static_assert(sample_clocks * config::Reference::adc_rate_hz == clock_hz && sample_clocks < 256,
              "whole clocks a sample, counted in a byte");

constexpr int word_bytes = 7;
constexpr int request_header = 0xa5;
constexpr int response_header = 0x5a;
constexpr int record_header = 0xc3;
constexpr int read_command = 0;
constexpr int write_command = 1;
constexpr int done = 0;
constexpr int refused = 1;
constexpr int request_bytes = 3 + word_bytes + 2;
constexpr int record_bytes = 3 + config::record_words * word_bytes + 2;
static_assert(10 * config::output_rate_hz * (record_bytes + 2 * request_bytes) < baud / 2,
              "records, and a response beside each, leave half of the line free");

constexpr int record_base = 0x40;  ///< word i of the last whole record at record_base + i
constexpr std::uint32_t identity_word = 0x48454d42;
enum Control { control_run = 1, control_reset = 2 };
enum Fault { fault_sample_lost = 1, fault_words_late = 2, fault_bad_request = 4, fault_request_lost = 8 };
constexpr NamedAddress addresses[] = {
    {"identity", 0x60, "r", "\"HEMB\", 0x48454d42"},
    {"shape", 0x61, "r", "ADC bits, decimation, record words, registers: a byte each, from the top"},
    {"control", 0x62, "rw",
     "bit 0 run: samples are taken; bit 1 reset: stop, reset the core and its registers"},
    {"faults", 0x63, "rw1c",
     "since cleared: bit 0 sample lost, 1 DAC words late, 2 request with a wrong CRC, 3 request before the "
     "last was "
     "answered"},
};

}  // namespace board
}  // namespace hemi

#endif  // HEMI_RTL_ADDRESS_MAP_HPP

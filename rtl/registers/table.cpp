// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "rtl/address_map.hpp"
#include "rtl/registers/description.hpp"

namespace hemi::registers {
namespace {

constexpr const char* head = R"(# Registers, records, addresses

Written by `hemi_registers` from `hls/config.hpp` and `rtl/address_map.hpp`, as are the packages `hemi_axi_pkg`, `hemi_board_pkg` and
`hemi_registers_pkg` and the C header `hemi_registers.h` (the last two in the build's `rtl/`); the test `registers.stale` fails when this page or a
package is not what the description says. `scripts/registers` writes them anew. `hemi export` makes the words for a model.

A word is signed, value = raw / 2^fraction; full scale is +-2^(bits - 1 - fraction), its upper end less one step. Words are written sign-extended to 54 bits.
What the core does with each stands in [chain.md](chain.md).

)";

std::string scale_of(config::Format format) {
  return fmt::format("{} | {} | {:.6g} | {:.4g}", format.width, format.fraction,
                     std::ldexp(1.0, format.width - 1 - format.fraction), std::ldexp(1.0, -format.fraction));
}

std::string register_rows() {
  std::string text =
      "## Registers\n\n| index | AXI | name | bits | fraction | full scale | step | unit | what |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  const auto row = [&](int i, const char* name, config::Format format, const char* unit,
                       const char* meaning) {
    text += fmt::format("| {} | 0x{:03x} | `{}` | {} | {} | {} |\n", i, 8 * i, name, scale_of(format), unit,
                        meaning);
  };
  for (int i = 0; i < config::register_count; ++i) {
    const auto& r = config::registers[i];
    row(i, r.name, r.format, r.unit, r.meaning);
  }
  row(telemetry_frequency_address, "telemetry_frequency", config::frequency, "Hz",
      "of the next telemetry sample");
  row(telemetry_rate_address, "telemetry_rate", config::rate, "deg/h", "of it");
  return text;
}

std::string record_rows() {
  std::string text =
      "\n## Record\n\n| word | AXI | board | name | bits | fraction | full scale | step | unit | what |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (int i = 0; i < config::record_words; ++i) {
    const auto& r = record_layout[i];
    text += fmt::format("| {} | 0x{:03x} | 0x{:02x} | `{}` | {} | {} | {} |\n", i, axi::record_base + 8 * i,
                        board::record_base + i, r.name, scale_of(r.format), r.unit, r.meaning);
  }
  return text;
}

std::string status_rows() {
  std::string text = "\n## Status\n\n| live bit | sticky bit | name |\n| --- | --- | --- |\n";
  for (int i = 0; i < config::status_bits; ++i)
    text += fmt::format("| {} | {} | `{}` |\n", i, i + config::status_shift, config::status_names[i]);
  return text;
}

template <class Addresses>
std::string address_rows(const char* title, int digits, const Addresses& addresses) {
  std::string text =
      fmt::format("\n## {}\n\n| address | access | name | what |\n| --- | --- | --- | --- |\n", title);
  for (const auto& a : addresses)
    text += fmt::format("| 0x{:0{}x} | {} | `{}` | {} |\n", a.address, digits, a.access, a.name, a.meaning);
  return text;
}

}  // namespace

std::string table() {
  return head + register_rows() + record_rows() + status_rows() +
         address_rows("AXI, beside registers and record (bytes; [fpga.md](fpga.md))", 3, axi::addresses) +
         address_rows("Board, beside registers and record (words; [board.md](board.md))", 2,
                      board::addresses);
}

}  // namespace hemi::registers

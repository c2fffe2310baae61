// SPDX-License-Identifier: Apache-2.0
#include "rtl/microcode/assembler.hpp"

#include <algorithm>
#include <stdexcept>

#include "rtl/address_map.hpp"

namespace hemi::microcode {
namespace {

/// Modes have 5 bits in an instruction.
constexpr std::size_t max_modes = 32;

std::vector<Mode> all_modes(int cic_bits) {
  constexpr int lowest_bit = 1;
  std::vector<Mode> modes = {{word_bits}, {cic_bits}, {lowest_bit}};
  for (const config::Format format :
       {config::phase, config::increment, config::angle, config::tick_phase, config::total_phase,
        config::frequency, config::rate_accumulator, config::block_sum}) {
    modes.push_back({format.width});
  }
  for (const config::Format format :
       {config::increment, config::baseband, config::rate_tick, config::rate, config::offset,
        config::fine_offset, config::temperature, config::slope_word, config::derivative, config::bias,
        config::command_integral, config::dac}) {
    modes.push_back({format.width, true});
  }
  modes.push_back({config::dac_sum.fraction - config::dac.fraction, false, true});
  std::sort(modes.begin() + 1, modes.end());
  modes.erase(std::unique(modes.begin(), modes.end()), modes.end());
  return modes;
}

}  // namespace

Assembler::Assembler(Instrument instrument)
    : instrument_(std::move(instrument)),
      modes_(all_modes(instrument_.cic_bits)),
      next_word_(symbolic_base),
      next_constant_(constant_base) {
  if (modes_.size() > max_modes) throw std::logic_error("more modes than an instruction can name");
}

Word Assembler::word(const std::string& name) {
  const auto [place, created] = words_.try_emplace(name, Word{next_word_});
  if (created) ++next_word_;
  return place->second;
}

Word Assembler::constant(std::int64_t value) {
  if (value == 0) return zero_word;
  constexpr std::int64_t limit = std::int64_t{1} << (constant_bits - 1);
  if (value < -limit || value >= limit) throw std::logic_error("a constant that is too wide");
  const auto [place, created] = constants_.try_emplace(value, Word{next_constant_});
  if (created && ++next_constant_ > 1 << operand_b_bits) throw std::logic_error("too many constants");
  return place->second;
}

Region& Assembler::region(const std::string& label) {
  Region& region = regions_.emplace_back();
  region.label = label;
  return region;
}

Word Assembler::product(Word wide, Word narrow) {
  line(Operation::multiply, nowhere(), wide, narrow).condition = Condition::never;
  return product_port;
}

Instruction& Assembler::look_up(Word dst, Word phase, bool cosine) {
  Instruction& angle = line(Operation::look_up, nowhere(), phase, zero());
  angle.condition = Condition::never;
  angle.shift = cosine ? 1 : 0;
  return line(Operation::mirror, dst, zero(), lookup_port);
}

Instruction& Assembler::shape(Word dst, Word error, Word sum, int shift, config::Format format) {
  Instruction& word = move(dst, sum).round(shift).saturate(format);
  word.before_residual = true;
  move(error, sum).mode = {shift, false, true};
  return word;
}

int Assembler::mode_code(Mode mode) const {
  const auto place = std::find(modes_.begin(), modes_.end(), mode);
  if (place == modes_.end()) throw std::logic_error("no such mode: " + std::to_string(mode.width) + " bits");
  return static_cast<int>(place - modes_.begin());
}

std::string Assembler::name_of(Word word) const {
  static const std::map<int, std::string> ports = {{product_port.address, "product"},
                                                   {lookup_port.address, "looked_up"},
                                                   {sample_x_port.address, "sample_x"},
                                                   {sample_y_port.address, "sample_y"},
                                                   {gap_port.address, "gap"},
                                                   {live_port.address, "live"},
                                                   {zero_word.address, "#0"},
                                                   {dac_drive_port.address, "dac_drive"},
                                                   {dac_rebalance_port.address, "dac_rebalance"},
                                                   {dac_quadrature_port.address, "dac_quadrature"}};
  if (word.address < config::register_count) return config::registers[word.address].name;
  if (word.address == telemetry_frequency_address) return "telemetry_frequency";
  if (word.address == telemetry_rate_address) return "telemetry_rate";
  if (const auto port = ports.find(word.address); port != ports.end()) return port->second;
  for (const auto& [name, place] : words_) {
    if (place == word) return name;
  }
  for (const auto& [value, place] : constants_) {
    if (place == word) return std::string("#").append(std::to_string(value));
  }
  throw std::logic_error("no word at address " + std::to_string(word.address));
}

Instruction& Assembler::line(Operation operation, Word dst, Word a, Word b) {
  if (regions_.empty()) throw std::logic_error("an instruction outside any region");
  if (is_port(a)) throw std::logic_error("a port or a constant as operand a");
  Instruction& instruction = regions_.back().lines.emplace_back();
  instruction.operation = operation;
  instruction.dst = dst;
  instruction.a = a;
  instruction.b = b;
  instruction.block = block_;
  return instruction;
}

}  // namespace hemi::microcode

// SPDX-License-Identifier: Apache-2.0
#include "rtl/microcode/listing.hpp"

#include <fmt/format.h>

#include "rtl/microcode/encode.hpp"

namespace hemi::microcode {
namespace {

std::string operand(const Assembler& m, const Instruction& i) {
  if (i.shift == 0) return m.name_of(i.b);
  const std::string bits = i.shift == variable_shift ? "variable" : std::to_string(i.shift);
  return fmt::format("{}({}, {})", i.round_half_up ? "round" : "floor", m.name_of(i.b), bits);
}

std::string arithmetic(const Assembler& m, const Instruction& i) {
  static const char* const signs[] = {"+", "-", "+/-", "-/+", "+mirror", "^"};
  if (i.control == Control::jump) return "jump " + i.target;
  if (i.operation == Operation::multiply)
    return fmt::format("product = {} * {}", m.name_of(i.a), m.name_of(i.b));
  if (i.operation == Operation::look_up)
    return fmt::format("look_up {} {}", i.shift ? "cos" : "sin", m.name_of(i.a));
  if (i.condition == Condition::never) return "-";
  return fmt::format("{} = {} {} {}", m.name_of(i.dst), m.name_of(i.a), signs[static_cast<int>(i.operation)],
                     operand(m, i));
}

std::string remarks(const Instruction& i) {
  static const char* const controls[] = {"",       "; yield",     "", "; emit", "; give_back", "; end",
                                         "; take", "; load_shift"};
  const bool computes = i.condition != Condition::never && i.control != Control::jump;
  std::string text;
  if (computes)
    text += fmt::format(" {}{}", i.mode.saturate ? "sat" : i.mode.residual ? "residual" : "", i.mode.width);
  if (i.condition == Condition::negative) text += " if negative";
  if (i.condition == Condition::not_negative) text += " if not negative";
  if (i.sets_negative) text += "; sets negative";
  if (i.event != no_event) text += fmt::format("; raises {}", config::status_names[i.event]);
  if (i.tap >= 0) text += fmt::format("; tap {}", config::taps[i.tap].name);
  return text + controls[static_cast<int>(i.control)];
}

}  // namespace

std::string listing(const Assembler& m, const Schedule& s) {
  std::string text;
  for (std::size_t address = 0; address < s.program.size(); ++address) {
    for (const auto& [label, entry] : s.entries) {
      if (entry == static_cast<int>(address)) text += label + ":\n";
    }
    const Instruction& i = s.program[address];
    text += fmt::format("{:4}  {:20}  {}{}\n", address, i.block, arithmetic(m, i), remarks(i));
  }
  return text;
}

std::string summary(const Assembler& m, const Schedule& s) {
  int used = 0;
  for (const Instruction& i : s.program) {
    used += i.condition != Condition::never || i.operation != Operation::add || i.control != Control::next;
  }
  std::string text = fmt::format("instrument {}\n", m.instrument().name);
  text +=
      fmt::format("program words {} ({} in use), {} bits each\n", s.program.size(), used, instruction_bits);
  text += fmt::format("state words {} of {} for {} names, constants {}\n", s.state_end, first_reserved,
                      m.words().size(), m.constants().size());
  for (const Region& region : m.regions()) {
    text += fmt::format("clocks {:10} {:4}  ({} instructions)\n", region.label, s.clocks.at(region.label),
                        region.lines.size());
  }
  text += fmt::format("longest slice {}, sample and slice {} of {}\n", s.longest_slice,
                      s.longest_slice + s.clocks.at("sample"), clocks_per_sample);
  return text;
}

}  // namespace hemi::microcode

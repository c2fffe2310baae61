// SPDX-License-Identifier: Apache-2.0
#include "rtl/microcode/dependence.hpp"

#include <algorithm>

namespace hemi::microcode {
namespace {

bool uses_negative(const Instruction& i) {
  return i.condition == Condition::negative || i.condition == Condition::not_negative ||
         i.operation == Operation::add_if_negative || i.operation == Operation::subtract_if_negative;
}

bool reads_sample(const Instruction& i) {
  return i.b == sample_x_port || i.b == sample_y_port || i.b == gap_port;
}

bool needs_order(const Instruction& i) {
  return i.control == Control::emit || reads_sample(i) ||
         (i.condition != Condition::never && is_dac_port(i.dst));
}

int memory_distance(const Instruction& first, const Instruction& second, Word nowhere) {
  int clocks = 0;
  if (writes(first, nowhere)) {
    if (reads(second, first.dst)) clocks = latency::word;
    if (writes(second, nowhere) && second.dst == first.dst) clocks = std::max(clocks, 1);
  }
  if (writes(second, nowhere) && reads(first, second.dst)) clocks = std::max(clocks, 1);
  return clocks;
}

int sign_distance(const Instruction& first, const Instruction& second) {
  if (first.sets_negative && uses_negative(second)) return latency::negative;
  return second.sets_negative && (first.sets_negative || uses_negative(first)) ? 1 : 0;
}

int shift_distance(const Instruction& first, const Instruction& second) {
  const bool loads = first.control == Control::load_shift;
  const bool loads_next = second.control == Control::load_shift;
  const bool uses = first.shift == variable_shift;
  const bool uses_next = second.shift == variable_shift;
  return (loads && (uses_next || loads_next)) || (uses && loads_next) ? latency::shift : 0;
}

int status_distance(const Instruction& first, const Instruction& second) {
  if (first.event != no_event && second.b == live_port) return latency::live;
  return first.b == live_port && second.event != no_event ? 1 : 0;
}

}  // namespace

bool reads_a(const Instruction& i) {
  return i.condition != Condition::never || i.operation == Operation::multiply ||
         i.operation == Operation::look_up;
}

bool reads_b(const Instruction& i) {
  return !is_port(i.b) && (i.condition != Condition::never || i.operation == Operation::multiply);
}

bool reads(const Instruction& i, Word word) {
  return (reads_a(i) && i.a == word) || (reads_b(i) && i.b == word);
}

bool writes(const Instruction& i, Word nowhere) {
  return i.condition != Condition::never && !(i.dst == nowhere);
}

int result_latency(const Instruction& i) {
  if (i.operation == Operation::multiply) return latency::product;
  if (i.operation == Operation::look_up) return latency::lookup;
  return i.before_residual ? latency::clip : 0;
}

int distance(const Instruction& first, const Instruction& second, Word nowhere) {
  const int order = needs_order(first) && needs_order(second) ? 1 : 0;
  return std::max({memory_distance(first, second, nowhere), sign_distance(first, second),
                   shift_distance(first, second), status_distance(first, second), order});
}

}  // namespace hemi::microcode

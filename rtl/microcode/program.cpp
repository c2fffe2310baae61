// SPDX-License-Identifier: Apache-2.0
// The order of the blocks, and the words that pass between samples, ticks and outputs.
#include "rtl/address_map.hpp"
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

/// Before the first sample: the nco starts with nco_start.
void start(Assembler& m) {
  Region& region = m.region("start");
  region.background = false;
  m.block("reference_phase_loop");
  for (const char* name : {"integral", "pending", "increment"})
    m.move(m.word(name), m.reg(config::reg_nco_start));
}

void sample(Assembler& m) {
  Region& region = m.region("sample");
  region.background = false;
  region.last = Control::give_back;
  modulator_carrier(m);
  nco(m);
  demodulator(m);
  modulator_sample(m);
  cic_sample(m);
}

void tick(Assembler& m) {
  Region& region = m.region("tick");
  region.follows_sample = true;
  region.jump_target = "idle";
  region.jump_condition = Condition::negative;
  m.block("reference_phase_loop");
  m.move(m.word("increment"), m.word("pending"));
  modulator_take_over(m);
  cic_tick(m);
  image_filter(m);
  phase_detector(m);
  start_up(m);
  reference_phase_loop(m);
  actuator_loops(m);
  modulator_tick(m);
  frequency_tracker_tick(m);
  rate_filter_tick(m);
  m.block("output");
  m.add(m.word("tick_count"), m.word("tick_count"), m.constant(1));
  m.compare(m.word("tick_count"), m.constant(config::ticks_per_output));
}

void output(Assembler& m) {
  m.region("output");
  frequency_tracker_output(m);
  rate_filter_output(m);
  m.block("output");
  const Word count = m.word("output_count");
  const Word invalid = m.word("frequency_invalid");
  m.clear(m.word("tick_count"));
  m.subtract(invalid, count, m.constant(2)).set_negative().raise(config::status_frequency_invalid);
  m.add(count, count, m.constant(1)).if_negative();
  m.add(m.word("not_good"), invalid, m.word("not_locked"));
}

/// From here on the chain's outputs and telemetry samples go the same way.
void finish(Assembler& m) {
  Region& region = m.region("finish");
  region.jump_target = "settle";
  region.jump_condition = Condition::negative;
  thermometer(m);
  parity(m);
  derivative_sum(m);
  m.region("block");
  derivative_block(m);
  m.region("settle");
  derivative_state(m);
  bias_model(m);
  status(m);
}

/// Nothing but the end of the background's work.
void idle(Assembler& m) {
  Region& region = m.region("idle");
  region.in_order = true;
  region.last = Control::end;
  m.block("output");
  m.clear(m.nowhere());
}

void telemetry(Assembler& m) {
  Region& region = m.region("telemetry");
  region.jump_target = "finish";
  m.block("output");
  m.move(m.word("frequency"), Word{telemetry_frequency_address});
  m.move(m.word("rate"), Word{telemetry_rate_address});
  for (const char* name : {"amplitude_word", "error_word", "drive_word", "quadrature_word"})
    m.clear(m.word(name));
  m.move(m.word("not_good"), gap_port).raise(config::status_frequency_invalid).then(Control::take);
}

}  // namespace

void record(Assembler& m) {
  m.region("record").in_order = true;
  m.block("output");
  for (const char* name : {"frequency", "temperature", "derivative", "amplitude_word", "error_word",
                           "drive_word", "quadrature_word", "bias", "rate", "compensated", "status"}) {
    m.move(m.nowhere(), m.word(name)).then(Control::emit);
  }
}

void write_program(Assembler& m) {
  start(m);
  sample(m);
  tick(m);
  output(m);
  finish(m);
  record(m);
  idle(m);
  telemetry(m);
}

}  // namespace hemi::microcode

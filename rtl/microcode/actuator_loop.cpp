// SPDX-License-Identifier: Apache-2.0
//
// amplitude_loop, quadrature_loop, rebalance_loop: one proportional-integral controller each.
//
//   command = limit(integral + kp e),  integral += ki e unless that drives the command further beyond the
//   limit
//
// in       amplitude Q2.32, secondary Q1.27, state, low; gains, limits and starts from their registers
// out      drive, quadrature, rebalance Q2.30: in force one tick later
// clocks   130 a tick, all three side by side
// rounding products half up to 2^-40 and clipped to 44 bits; commands floored to 2^-30 (.._saturated: the
// limit)
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

struct Loop {
  const char* block;
  std::string name;
  config::RegisterIndex proportional, integral, limit;
  int start;  ///< register; negative: starts from 0
  config::StatusBit saturated;
  config::TapIndex integral_tap, command_tap;
  config::LoopState closed_from;
};

const Loop loops[] = {
    {"amplitude_loop", "drive", config::reg_amplitude_proportional, config::reg_amplitude_integral,
     config::reg_drive_limit, config::reg_drive_start, config::status_drive_saturated,
     config::tap_drive_integral, config::tap_drive, config::state_rise},
    {"quadrature_loop", "quadrature", config::reg_quadrature_proportional, config::reg_quadrature_integral,
     config::reg_quadrature_limit, config::reg_quadrature_start, config::status_quadrature_saturated,
     config::tap_quadrature_integral, config::tap_quadrature, config::state_run},
    {"rebalance_loop", "rebalance", config::reg_rebalance_proportional, config::reg_rebalance_integral,
     config::reg_rebalance_limit, -1, config::status_rebalance_saturated, config::tap_rebalance_integral,
     config::tap_rebalance, config::state_rise}};

constexpr int widening = config::command_integral.fraction - config::command.fraction;

/// A temporary of one loop.
Word part(Assembler& m, const Loop& loop, const char* name) {
  return m.word(loop.name + "_" + name);
}

void errors(Assembler& m) {
  const Word amplitude = m.word("drive_error");
  m.block("amplitude_loop");
  m.subtract(amplitude, m.reg(config::reg_amplitude_setpoint), m.word("amplitude"));
  m.move(amplitude, amplitude)
      .round(config::cordic.fraction - config::baseband.fraction)
      .saturate(config::baseband);
  m.block("quadrature_loop");
  m.move(m.word("quadrature_error"), m.word("secondary_quadrature"));
  m.block("rebalance_loop");
  m.subtract(m.word("rebalance_error"), m.zero(), m.word("secondary_in_phase")).saturate(config::baseband);
}

void multiply(Assembler& m, const Loop& loop, const char* name, config::RegisterIndex gain) {
  const int fraction = config::baseband.fraction + config::registers[gain].format.fraction;
  m.move(part(m, loop, name), m.product(part(m, loop, "error"), m.reg(gain)))
      .round(fraction - config::command_integral.fraction)
      .saturate(config::command_integral);
}

/// A command with the fraction of an integral.
Word widened(Assembler& m, Word command) {
  return m.product(command, m.constant(std::int64_t{1} << widening));
}

void parts(Assembler& m, const Loop& loop) {
  multiply(m, loop, "p", loop.proportional);
  multiply(m, loop, "i", loop.integral);
  m.move(part(m, loop, "limit"), widened(m, m.reg(loop.limit)));
}

/// working: negative when the loop is closed and the signal is there.
void modes(Assembler& m, const Loop& loop) {
  const Word on = part(m, loop, "on");
  const Word working = part(m, loop, "working");
  m.move(on, m.constant(loop.closed_from - 1));
  m.subtract(on, on, m.word("state"));
  m.move(working, on);
  m.test(m.word("low"));
  m.clear(working).if_negative();
}

/// No integral while the amplitude rises: it would only wind up.
void proportional_alone(Assembler& m) {
  m.block("amplitude_loop");
  m.compare(m.word("state"), m.constant(config::state_run));
  m.clear(m.word("drive_i")).if_negative();
}

/// high: negative when the integral would drive the command further beyond the limit.
void anti_windup(Assembler& m, const Loop& loop) {
  const Word limit = part(m, loop, "limit");
  const Word i = part(m, loop, "i");
  const Word next = part(m, loop, "next");
  const Word sum = part(m, loop, "sum");
  const Word high = part(m, loop, "high");
  const Word low = part(m, loop, "low");
  m.add(next, part(m, loop, "integral"), i);
  m.add(sum, next, part(m, loop, "p"));
  m.clear(high);
  m.clear(low);
  m.test(part(m, loop, "working"));
  m.subtract(high, limit, sum).raise(loop.saturated).if_negative();
  m.add(low, sum, limit).raise(loop.saturated).if_negative();
  m.test(i);
  m.move(high, low).if_negative();
}

/// Cuts `x` to [-limit, limit].
void cut(Assembler& m, const Loop& loop, Word x) {
  const Word limit = part(m, loop, "limit");
  m.add(m.nowhere(), x, limit).set_negative();
  m.subtract(x, m.zero(), limit).if_negative();
  m.compare(limit, x);
  m.move(x, limit).if_negative();
}

void integrate(Assembler& m, const Loop& loop) {
  const Word next = part(m, loop, "next");
  m.test(part(m, loop, "high"));
  m.move(next, part(m, loop, "integral")).if_negative();
  m.add(part(m, loop, "sum"), next, part(m, loop, "p"));
}

/// Off, hold or what was computed.
void settle(Assembler& m, const Loop& loop) {
  const Word integral = part(m, loop, "integral");
  const Word command = m.word(loop.name);
  m.move(command, integral).floor(widening);
  m.test(part(m, loop, "working"));
  m.move(command, part(m, loop, "sum")).floor(widening).if_negative();
  m.move(integral, part(m, loop, "next")).if_negative();
  m.test(part(m, loop, "on"));
  m.clear(command).if_not_negative();
  if (loop.start < 0)
    m.clear(integral).if_not_negative();
  else
    m.move(integral, widened(m, m.reg(static_cast<config::RegisterIndex>(loop.start)))).if_not_negative();
  m.move(m.nowhere(), integral).send_to(loop.integral_tap);
}

void report(Assembler& m) {
  m.block("amplitude_loop");
  m.test(m.word("searching"));
  m.move(m.word("drive"), m.reg(config::reg_drive_limit)).if_negative();
  for (const Loop& loop : loops) {
    m.block(loop.block);
    m.move(m.nowhere(), m.word(loop.name)).send_to(loop.command_tap);
  }
}

}  // namespace

void actuator_loops(Assembler& m) {
  // Step by step for all three: the one's latencies are filled with the others' instructions.
  const auto each = [&](auto step) {
    for (const Loop& loop : loops) {
      m.block(loop.block);
      step(loop);
    }
  };
  errors(m);
  each([&](const Loop& loop) { parts(m, loop); });
  each([&](const Loop& loop) { modes(m, loop); });
  proportional_alone(m);
  each([&](const Loop& loop) { anti_windup(m, loop); });
  each([&](const Loop& loop) { cut(m, loop, part(m, loop, "next")); });
  each([&](const Loop& loop) { integrate(m, loop); });
  each([&](const Loop& loop) { cut(m, loop, part(m, loop, "sum")); });
  each([&](const Loop& loop) { settle(m, loop); });
  report(m);
}

}  // namespace hemi::microcode

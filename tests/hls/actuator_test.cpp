// SPDX-License-Identifier: Apache-2.0
// start_up, the actuator loops' controller and modulator against docs/chain.md and their equations.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "hls/actuators.hpp"

namespace {

using namespace hemi;
using namespace hemi::hls;

Registers levels() {
  Registers r;
  r.control = 1;
  r.nco_start = from_raw<Increment>(1000);
  r.amplitude_threshold = from_raw<CordicWord>(100);
  r.search_amplitude = from_raw<CordicWord>(200);
  r.closing_amplitude = from_raw<CordicWord>(1000);
  r.search_ticks = 3;
  r.search_step = from_raw<Increment>(40);
  r.search_span = from_raw<Increment>(60);
  r.holdover_ticks = 4;
  return r;
}

CordicWord amplitude(std::int64_t word) {
  return from_raw<CordicWord>(word);
}

TEST(StartUp, WalksFromSearchToRun) {
  const Registers r = levels();
  StartUp s;
  s.reset();
  EXPECT_FALSE(s.step(amplitude(199), false, r));
  EXPECT_EQ(s.state(), config::state_search);
  s.step(amplitude(200), false, r);
  EXPECT_EQ(s.state(), config::state_acquire);
  EXPECT_EQ(s.amplitude_mode(), LoopMode::off);
  s.step(amplitude(100), false, r);
  EXPECT_EQ(s.state(), config::state_acquire);
  s.step(amplitude(999), true, r);
  EXPECT_EQ(s.state(), config::state_rise);
  EXPECT_EQ(s.amplitude_mode(), LoopMode::proportional);
  EXPECT_EQ(s.quadrature_mode(), LoopMode::off);
  EXPECT_EQ(s.rebalance_mode(), LoopMode::closed);
  s.step(amplitude(999), true, r);
  EXPECT_EQ(s.state(), config::state_rise);
  s.step(amplitude(1000), true, r);
  EXPECT_EQ(s.state(), config::state_run);
  EXPECT_EQ(s.quadrature_mode(), LoopMode::closed);
  s.step(amplitude(1000), false, r);
  EXPECT_EQ(s.state(), config::state_acquire);
  s.step(amplitude(99), false, r);
  EXPECT_EQ(s.state(), config::state_search);
}

TEST(StartUp, SearchStepsThroughTheSpanAndRoundAgain) {
  const Registers r = levels();
  StartUp s;
  s.reset();
  const std::int64_t offsets[] = {40, -60, -20, 20, 60, -60};
  for (const std::int64_t offset : offsets) {
    EXPECT_FALSE(s.step(amplitude(0), false, r));
    EXPECT_FALSE(s.step(amplitude(0), false, r));
    EXPECT_TRUE(s.step(amplitude(0), false, r));
    EXPECT_EQ(raw(s.start(r)), 1000 + offset);
  }
}

TEST(StartUp, HoldsOverThenSearchesAgain) {
  const Registers r = levels();
  StartUp s;
  s.reset();
  s.step(amplitude(5000), false, r);
  s.step(amplitude(5000), true, r);
  s.step(amplitude(5000), true, r);
  ASSERT_EQ(s.state(), config::state_run);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(s.step(amplitude(0), true, r));
  EXPECT_EQ(s.rebalance_mode(), LoopMode::hold);
  s.step(amplitude(5000), true, r);  // the signal is back: the count starts anew
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(s.step(amplitude(0), true, r));
  EXPECT_TRUE(s.step(amplitude(0), true, r));
  EXPECT_EQ(s.state(), config::state_search);
  EXPECT_EQ(raw(s.start(r)), 1000);
}

TEST(StartUp, ControlOffKeepsEverythingOff) {
  Registers r = levels();
  r.control = 0;
  StartUp s;
  s.reset();
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(s.step(amplitude(5000), true, r));
  EXPECT_EQ(s.state(), config::state_open);
  EXPECT_EQ(s.rebalance_mode(), LoopMode::off);
}

using Kp = RegisterWord<config::reg_rebalance_proportional>;
using Ki = RegisterWord<config::reg_rebalance_integral>;

Command command(double x) {
  return from_raw<Command>(std::llround(std::ldexp(x, config::command.fraction)));
}

struct Controller {
  ActuatorLoop loop;
  Kp kp = from_raw<Kp>(3 << 13);
  Ki ki = from_raw<Ki>(1 << 16);  // 1/16
  bool saturated = false;
  void step(LoopMode mode, double error) {
    saturated = false;
    loop.step(mode, from_raw<Baseband>(std::llround(std::ldexp(error, 27))), kp, ki, command(0.25),
              command(0.75), saturated);
  }
  double out() const { return std::ldexp(static_cast<double>(raw(loop.command())), -30); }
  double integral() const { return std::ldexp(static_cast<double>(raw(loop.integral())), -40); }
};

TEST(ActuatorLoop, IsProportionalPlusIntegral) {
  Controller c;
  c.step(LoopMode::off, 0.5);
  EXPECT_EQ(c.out(), 0.0);
  EXPECT_EQ(c.integral(), 0.25);
  c.step(LoopMode::closed, 0.125);  // exact in every format
  EXPECT_EQ(c.integral(), 0.25 + 0.125 / 16);
  EXPECT_EQ(c.out(), 0.25 + 0.125 / 16 + 3 * 0.125);
  c.step(LoopMode::proportional, -0.125);
  EXPECT_EQ(c.integral(), 0.25 + 0.125 / 16);
  EXPECT_EQ(c.out(), 0.25 + 0.125 / 16 - 3 * 0.125);
  c.step(LoopMode::hold, 0.9);
  EXPECT_EQ(c.out(), 0.25 + 0.125 / 16);
  EXPECT_FALSE(c.saturated);
}

TEST(ActuatorLoop, DoesNotWindUpAndLeavesTheLimitAtOnce) {
  Controller c;
  c.step(LoopMode::off, 0.0);
  for (int i = 0; i < 1000; ++i) {
    c.step(LoopMode::closed, 0.5);
    EXPECT_TRUE(c.saturated);
    EXPECT_EQ(c.out(), 0.75);
    EXPECT_EQ(c.integral(), 0.25);
  }
  c.step(LoopMode::closed, -0.125);
  EXPECT_EQ(c.out(), 0.25 - 0.125 / 16 - 3 * 0.125);
  for (int i = 0; i < 1000; ++i) c.step(LoopMode::closed, -0.9);
  EXPECT_EQ(c.out(), -0.75);
}

TEST(ActuatorLoop, TheIntegralStopsAtTheLimit) {
  Controller c;
  c.kp = from_raw<Kp>(0);
  c.step(LoopMode::off, 0.0);
  for (int i = 0; i < 1000; ++i) c.step(LoopMode::closed, 0.01);
  EXPECT_TRUE(c.saturated);
  EXPECT_LE(c.integral(), 0.75);
  EXPECT_GE(c.integral(), 0.75 - 0.01 / 16);
}

TEST(ShapedDac, TheErrorStaysBelowOneStepAndItsSumIsCarried) {
  // First-order error feedback: the sum of all words differs from the sum of all commands by the last error
  // alone.
  std::mt19937_64 generator(5);
  std::uniform_int_distribution<std::int64_t> any(-(std::int64_t{1} << 29), std::int64_t{1} << 29);
  ShapedDac dac;
  dac.reset();
  std::int64_t balance = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::int64_t x = any(generator);
    balance += x - (raw(dac.step(from_raw<Command>(x))) << 15);
    ASSERT_LE(std::abs(balance), 1 << 14);
  }
}

TEST(ShapedDac, ClipsAndForgets) {
  ShapedDac dac;
  dac.reset();
  EXPECT_EQ(raw(dac.step(command(1.5))), 32767);
  EXPECT_EQ(raw(dac.step(command(0.0))), 0);
  EXPECT_EQ(raw(dac.step(command(-1.9))), -32768);
  EXPECT_EQ(raw(dac.step(command(0.0))), 0);
}

TEST(CarrierOffset, LeadsByTheDelayAtAnyFrequency) {
  Registers r;
  r.modulation_delay = from_raw<RegisterWord<config::reg_modulation_delay>>(std::llround(2.5 * (1 << 18)));
  r.modulation_phase = from_raw<Angle>(std::int64_t{1} << 28);
  for (const double hz : {4365.0, 4425.0, 4485.0}) {
    const double inc = hz / 1e5;
    const auto increment = from_raw<Increment>(std::llround(std::ldexp(inc, config::increment.fraction)));
    const double turns = std::ldexp(static_cast<double>(raw(CarrierOffset::value(increment, r))), -32);
    // The operand is cut to 2^-31 turn a sample; the result rounded to 2^-32.
    EXPECT_NEAR(turns, 1.0 / 16 + 2.5 * inc, 2.5 * std::ldexp(1.0, -31) + std::ldexp(1.0, -33));
  }
}

TEST(Modulator, DriveIsInPhaseWithTheVelocity) {
  // Word = -command sin: a quarter turn after the positive peak of x = cos the force is at its negative one.
  Actuators a;
  a.reset();
  Registers r = levels();
  r.drive_limit = command(0.5);
  NoProbe probe;
  Status status;
  status.reset();
  const Polar nothing{};
  a.start_up(nothing, false, r, probe);
  a.loops(nothing, Secondary{}, r.nco_start, r, status, probe);
  a.take_over();
  a.sample(from_raw<Phase>(std::int64_t{1} << 46), probe);
  EXPECT_NEAR(raw(a.drive_word()), -16384, 1);
  EXPECT_EQ(raw(a.rebalance_word()), 0);
}

}  // namespace

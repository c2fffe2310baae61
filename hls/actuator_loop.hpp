// SPDX-License-Identifier: Apache-2.0
//
// amplitude_loop, quadrature_loop, rebalance_loop: one proportional-integral controller each, at the loop
// rate.
//
//   command = limit(integral + kp e),  integral += ki e unless that drives the command further beyond the
//   limit
//
// in       error e Q1.27: set point - amplitude, + quadrature, - in phase; gains in their registers' formats
// out      command Q2.30, fraction of the actuator's full scale, in force one tick later
// latency  one tick
// rounding products half up to 2^-40 and clipped to 44 bits; command floored to 2^-30; limits are symmetrical
// (flag) source   anti-windup by conditional integration: Astrom, Hagglund, Advanced PID Control, 2006,
// ch. 3.5
#ifndef HEMI_HLS_ACTUATOR_LOOP_HPP
#define HEMI_HLS_ACTUATOR_LOOP_HPP

#include "hls/registers.hpp"

namespace hemi {
namespace hls {

/// What start_up lets a loop do in this tick.
enum class LoopMode { off, hold, proportional, closed };

class ActuatorLoop {
 public:
  void reset(const Command& start) {
    integral_ = widened(start);
    command_ = Command();
  }

  template <class Proportional, class Integral>
  void step(LoopMode mode, const Baseband& error, const Proportional& kp, const Integral& ki,
            const Command& start, const Command& limit, bool& saturated) {
    if (mode == LoopMode::off) {
      reset(start);
    } else if (mode == LoopMode::hold) {
      command_ = quantise<Command>(integral_);
    } else {
      const CommandIntegral growth = mode == LoopMode::closed ? part(error * ki) : CommandIntegral();
      close(part(error * kp), growth, widened(limit), saturated);
    }
  }

  CommandIntegral integral() const { return integral_; }
  Command command() const { return command_; }

 private:
  template <class Expression>
  static CommandIntegral part(const Expression& product) {
    return quantise<CommandIntegral>(quantise<Clipped<config::command_integral>>(product));
  }
  static CommandIntegral widened(const Command& x) { return quantise<CommandIntegral>(x); }
  template <class Expression>
  static CommandIntegral limited(const Expression& x, const CommandIntegral& limit) {
    if (x > limit) return limit;
    if (x < -limit) return quantise<CommandIntegral>(-limit);
    return quantise<CommandIntegral>(x);
  }

  void close(const CommandIntegral& p, const CommandIntegral& i, const CommandIntegral& limit,
             bool& saturated) {
    const auto next = integral_ + i;
    const bool high = next + p > limit;
    const bool low = next + p < -limit;
    const bool winds_up = (high && !is_negative(i)) || (low && is_negative(i));
    if (!winds_up) integral_ = limited(next, limit);
    command_ = quantise<Command>(limited(integral_ + p, limit));
    saturated = saturated || high || low;
  }

  CommandIntegral integral_;
  Command command_;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_ACTUATOR_LOOP_HPP

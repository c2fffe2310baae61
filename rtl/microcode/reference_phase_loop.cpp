// SPDX-License-Identifier: Apache-2.0
//
// reference_phase_loop: steers the nco onto the primary; lock detector, hold-over, re-acquisition.
//
//   increment = integral + kp e,  integral += ki e  (+ kf (e - e_last) while unlocked and far off), e =
//   phase_error
//
// in       phase_error Q0.32 turns, low: -1 below the amplitude threshold, else 0; gains kp, kf, ki
// out      pending Q1.48 turns a sample: in force one tick later clocks   40 a tick rounding products
// half up to 2^-48; sums clip (loop_saturated) source   F. M. Gardner, Phaselock Techniques, 3rd ed., ch. 2
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

int product_shift(config::RegisterIndex gain) {
  return config::angle.fraction + config::registers[gain].format.fraction - config::increment.fraction;
}

void steer(Assembler& m, Word dst, Word error, config::RegisterIndex gain) {
  m.add(dst, m.word("integral"), m.product(error, m.reg(gain)))
      .round(product_shift(gain))
      .saturate(config::increment)
      .raise(config::status_loop_saturated)
      .if_not_negative();
}

void filter(Assembler& m) {
  const Word error = m.word("phase_error");
  const Word integral = m.word("integral");
  const Word pending = m.word("pending");
  const Word change = m.word("error_change");
  m.subtract(change, error, m.word("last_error")).wrap(config::angle);
  m.move(m.word("last_error"), error);
  // Near the carrier nothing steers: the change counts as zero.
  const Word far = m.constant(std::int64_t{1} << config::steering_window_log2);
  const Word steering = m.word("steering_change");
  m.clear(steering);
  m.add(m.nowhere(), change, far).set_negative();
  m.move(steering, change).if_negative();
  m.compare(change, far);
  m.move(steering, change).if_not_negative();
  m.subtract(m.nowhere(), m.word("low"), m.word("locked")).set_negative();
  steer(m, integral, steering, config::reg_loop_frequency);
  m.test(m.word("low"));
  steer(m, integral, error, config::reg_loop_integral);
  steer(m, pending, error, config::reg_loop_proportional);
  m.move(pending, integral).if_negative();
  m.move(m.nowhere(), integral).send_to(config::tap_loop_integral);
  m.move(m.nowhere(), pending).send_to(config::tap_loop_increment);
}

void count(Assembler& m) {
  const Word error = m.word("phase_error");
  const Word window = m.constant(std::int64_t{1} << config::lock_window_log2);
  const Word limit = m.reg(config::reg_lock_count);
  const Word counter = m.word("lock_counter");
  const Word next = m.word("next_counter");
  const Word up = m.word("counter_up");
  const Word down = m.word("counter_down");
  m.add(up, counter, m.constant(1));
  m.move(next, limit);
  m.compare(up, limit);
  m.move(next, up).if_negative();
  m.subtract(down, counter, m.constant(config::lock_penalty)).set_negative();
  m.clear(down).if_negative();
  m.add(m.nowhere(), error, window).set_negative();
  m.move(next, down).if_negative();
  m.compare(error, window);
  m.move(next, down).if_not_negative();
  m.test(m.word("low"));
  m.move(counter, next).if_not_negative();
  m.move(m.nowhere(), counter).send_to(config::tap_lock_counter);
}

void lock(Assembler& m) {
  const Word counter = m.word("lock_counter");
  const Word locked = m.word("locked");
  const Word magnitude = m.word("counter_magnitude");
  const Word not_locked = m.word("not_locked");
  m.compare(counter, m.reg(config::reg_lock_count));
  m.move(locked, m.constant(1)).if_not_negative();
  m.test(counter);
  m.subtract_if_negative(magnitude, m.zero(), counter);
  m.compare(magnitude, m.constant(1));
  m.clear(locked).if_negative();
  m.subtract(not_locked, locked, m.constant(1)).raise(config::status_unlocked);
  m.subtract(m.nowhere(), m.word("low"), not_locked).raise(config::status_holdover);
}

}  // namespace

void reference_phase_loop(Assembler& m) {
  m.block("reference_phase_loop");
  filter(m);
  count(m);
  lock(m);
}

}  // namespace hemi::microcode

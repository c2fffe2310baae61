// SPDX-License-Identifier: Apache-2.0
//
// start_up: search, lock, amplitude rise, closing of quadrature and rebalance; hold-over and return to the
// search.
//
//   open (control = 0) | search -> acquire -> rise -> run, each tick at most one step (docs/chain.md has the
//   table)
//
// in       amplitude Q2.32, locked as the phase loop left it at the tick before
// out      state; restart: the phase loop's words are set back here; closed_loop, low: negative when so
// clocks   80 a tick
//
// Without jumps: a condition is a word that is negative when it holds, and two of them are joined by clearing
// the one where the other does not hold. Which line of the table counts is chosen by the state of the tick
// before; the lines that do not count leave no trace.
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

/// Clears `condition` where `also` does not hold.
void restrict_to(Assembler& m, Word condition, Word also) {
  m.test(also);
  m.clear(condition).if_not_negative();
}

/// due: count >= limit, joined with `also`.
void count_up(Assembler& m, Word due, Word count, config::RegisterIndex limit, Word also) {
  m.test(also);
  m.add(count, count, m.constant(1)).if_negative();
  m.subtract(due, m.reg(limit), count);
  m.subtract(due, due, m.constant(1));
  restrict_to(m, due, also);
}

/// Which line of the table counts.
void choose(Assembler& m) {
  const Word state = m.word("state");
  const Word closed_loop = m.word("closed_loop");
  const Word seeking = m.word("seeking");
  const Word low = m.word("low");
  m.move(closed_loop, m.reg(config::reg_control)).wrap(1);
  m.subtract(low, m.word("amplitude"), m.reg(config::reg_amplitude_threshold));
  m.move(low, low).floor(word_bits);
  m.add(seeking, state, closed_loop);
  m.add(seeking, seeking, closed_loop);  // with control = 0 the state is open, and stays so
  m.move(m.word("beyond_search"), m.constant(1));
  m.subtract(m.word("beyond_search"), m.word("beyond_search"), state);
  m.move(m.word("following"), m.constant(config::state_acquire));
  m.subtract(m.word("following"), m.word("following"), state);
  m.move(m.word("next_state"), state);
}

void search(Assembler& m) {
  const Word seeking = m.word("seeking");
  const Word missing = m.word("missing");
  const Word due = m.word("search_due");
  const Word past = m.word("past_span");
  const Word offset = m.word("search_offset");
  const Word next = m.word("next_state");
  const Word span = m.reg(config::reg_search_span);
  m.subtract(missing, m.word("amplitude"), m.reg(config::reg_search_amplitude));
  restrict_to(m, missing, seeking);
  m.move(next, m.constant(config::state_acquire)).if_negative();
  m.test(missing);
  m.move(next, m.constant(config::state_search)).if_negative();
  count_up(m, due, m.word("search_count"), config::reg_search_ticks, missing);
  m.test(due);
  m.clear(m.word("search_count")).if_negative();
  m.add(offset, offset, m.reg(config::reg_search_step)).wrap(config::increment).if_negative();
  m.subtract(past, span, offset);
  restrict_to(m, past, due);
  m.test(past);
  m.subtract(offset, m.zero(), span).wrap(config::increment).if_negative();
}

/// acquire, rise and run with a signal.
void go_on(Assembler& m) {
  const Word state = m.word("state");
  const Word following = m.word("following");
  const Word steady = m.word("steady");
  const Word locked = m.word("steady_locked");
  const Word below = m.word("below_closing");
  const Word upwards = m.word("upwards");
  const Word next = m.word("next_state");
  m.move(steady, m.word("beyond_search"));
  m.test(m.word("low"));
  m.clear(steady).if_negative();
  m.clear(m.word("holdover_count")).if_not_negative();
  m.clear(locked);
  m.test(steady);
  m.move(next, m.constant(config::state_acquire)).if_negative();
  m.subtract(locked, m.zero(), m.word("locked")).if_negative();
  m.subtract(below, m.word("amplitude"), m.reg(config::reg_closing_amplitude));
  m.move(upwards, m.constant(config::state_rise));
  m.test(following);
  m.clear(below).if_not_negative();
  m.move(upwards, m.constant(config::state_run)).if_negative();
  m.test(below);
  m.move(upwards, state).if_negative();
  m.test(locked);
  m.move(next, upwards).if_negative();
}

/// acquire, rise and run without a signal.
void hold_over(Assembler& m) {
  const Word beyond = m.word("beyond_search");
  const Word fading = m.word("fading");
  const Word due = m.word("holdover_due");
  const Word next = m.word("next_state");
  restrict_to(m, beyond, m.word("low"));
  m.test(beyond);
  m.move(next, m.constant(config::state_search)).if_negative();
  m.move(fading, m.word("following"));
  restrict_to(m, fading, m.word("low"));
  m.test(fading);
  m.move(next, m.word("state")).if_negative();
  count_up(m, due, m.word("holdover_count"), config::reg_holdover_ticks, fading);
  m.test(due);
  m.move(next, m.constant(config::state_search)).if_negative();
  for (const char* name : {"holdover_count", "search_count", "search_offset"})
    m.clear(m.word(name)).if_negative();
}

void restart(Assembler& m) {
  const Word again = m.word("start_again");
  const Word start = m.word("loop_start");
  m.add(start, m.reg(config::reg_nco_start), m.word("search_offset")).wrap(config::increment);
  m.add(again, m.word("search_due"), m.word("holdover_due"));  // at most one of them is negative
  m.test(again);
  m.move(m.word("integral"), start).if_negative();
  m.move(m.word("pending"), start).if_negative();
  m.clear(m.word("lock_counter")).if_negative();
  m.clear(m.word("locked")).if_negative();
}

void report(Assembler& m) {
  const Word state = m.word("state");
  const Word searching = m.word("searching");
  m.move(state, m.word("next_state")).send_to(config::tap_state);
  m.clear(searching);
  m.compare(state, m.constant(config::state_acquire));
  m.subtract(searching, m.zero(), state).raise(config::status_searching).if_negative();
  m.compare(state, m.constant(config::state_run));
  m.subtract(m.nowhere(), m.zero(), state).raise(config::status_starting).if_negative();
}

}  // namespace

void start_up(Assembler& m) {
  m.block("start_up");
  static_assert(config::state_open == 0 && config::state_search == 1 && config::state_acquire == 2 &&
                    config::state_rise == 3 && config::state_run == 4,
                "the comparisons take the states in this order");
  choose(m);
  search(m);
  go_on(m);
  hold_over(m);
  restart(m);
  report(m);
}

}  // namespace hemi::microcode

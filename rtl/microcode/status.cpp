// SPDX-License-Identifier: Apache-2.0
//
// status: live flags of the output interval, sticky ones since the first lock; parity of the registers.
//
//   sticky |= live once an output was locked, all loops closed and its frequency valid;  status = sticky
//   2^24 + live
//
// in       flags as the other blocks raise them; out: status, once an output
// clocks   59 an output for the parity, 16 for the flags
// The machine has sums and exclusive or: a | b = (a + b) - (a & b), a & b = ((a + b) - (a ^ b)) / 2.
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {

void parity(Assembler& m) {
  m.block("status");
  constexpr int chains = 4;
  for (int i = 0; i < config::register_count; ++i) {
    const Word sum = m.word("parity_sum", i % chains);
    const Word next = m.reg(static_cast<config::RegisterIndex>(i));
    m.exclusive_or(sum, i < chains ? m.zero() : sum, next);
  }
  m.exclusive_or(m.word("parity_sum", 0), m.word("parity_sum", 0), m.word("parity_sum", 1));
  m.exclusive_or(m.word("parity_sum", 2), m.word("parity_sum", 2), m.word("parity_sum", 3));
  m.exclusive_or(m.word("parity_sum", 0), m.word("parity_sum", 0), m.word("parity_sum", 2));
  m.move(m.nowhere(), m.word("parity_sum", 0)).raise(config::status_parity_error);
  m.subtract(m.nowhere(), m.zero(), m.word("parity_sum", 0)).raise(config::status_parity_error);
}

void status(Assembler& m) {
  m.block("status");
  static_assert(config::status_unlocked == 0 && config::status_starting == config::status_bits - 2 &&
                    config::status_frequency_invalid == config::status_bits - 1,
                "lowest and the two highest bits");
  const Word live = m.word("live");
  const Word half = m.word("live_half");
  const Word lowest = m.word("live_lowest");
  const Word highest = m.word("live_highest");
  const Word armed = m.word("armed");
  const Word sum = m.word("flag_sum");
  const Word both = m.word("flags_in_both");
  const Word sticky = m.word("sticky");
  m.move(live, live_port);
  m.move(half, live).floor(1);
  m.subtract(lowest, live, half);
  m.subtract(lowest, lowest, half);
  m.move(highest, live).floor(config::status_bits - 2);
  m.add(highest, highest, lowest);
  m.compare(highest, m.constant(1));
  m.move(armed, m.constant(1)).if_negative();
  m.add(sum, sticky, live);
  m.exclusive_or(both, sticky, live);
  m.subtract(both, sum, both);
  m.compare(armed, m.constant(1));
  m.subtract(sticky, sum, both).floor(1).if_not_negative();
  // 2^23 is the widest factor, and only with a minus.
  m.add(sum, sticky, sticky);
  m.subtract(m.word("status"), live,
             m.product(sum, m.constant(-(std::int64_t{1} << (config::status_shift - 1)))))
      .send_to(config::tap_status);
}

}  // namespace hemi::microcode

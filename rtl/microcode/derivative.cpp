// SPDX-License-Identifier: Apache-2.0
//
// derivative: df/dt by least squares over 16 blocks of M = 2^log2_block outputs.
//
//   slope_sum = sum_{j=0..7} (15 - 2j) (b[15-j] - b[j]);  derivative = slope_sum 2^-slope_shift slope_gain
//
// in       frequency - frequency_reference Q18.29, once an output; not_good: negative where it must not be
// used out      derivative Q1.23 of its full scale; moves once a block clocks   12 an output, 50 more a block
// rounding half up and clipped (derivative_saturated); the block sum wraps
#include "rtl/microcode/blocks.hpp"

namespace hemi::microcode {
namespace {

Word history(Assembler& m, int block) {
  return m.word("block", block);
}

/// sum (15 - 2j) e_j = sum e_j + 2 sum (7 - j) e_j; the second is the sum of the partial sums of the first.
Word slope_sum(Assembler& m) {
  constexpr int pairs = config::derivative_blocks / 2;
  const Word sum = m.word("slope", 0);
  const Word sum_of_sums = m.word("slope", 1);
  m.clear(sum);
  m.clear(sum_of_sums);
  for (int j = 0; j < pairs; ++j) {
    const Word pair = m.word("slope", 2 + j % 4);
    m.subtract(pair, history(m, config::derivative_blocks - 1 - j), history(m, j));
    m.add(sum, sum, pair);
    if (j + 1 < pairs) m.add(sum_of_sums, sum_of_sums, sum);
  }
  m.add(sum, sum, sum_of_sums);
  m.add(sum, sum, sum_of_sums);
  return sum;
}

}  // namespace

void derivative_sum(Assembler& m) {
  m.block("derivative");
  const Word fine = m.word("fine_offset");
  const Word sum = m.word("block_sum");
  const Word count = m.word("block_count");
  m.test(m.word("not_good"));
  m.move(fine, m.word("frequency_difference"))
      .round(config::frequency.fraction - config::fine_offset.fraction)
      .saturate(config::fine_offset)
      .raise(config::status_derivative_saturated)
      .if_not_negative();
  m.add(sum, sum, fine).wrap(config::block_sum).if_not_negative();
  m.add(count, count, m.constant(1)).if_not_negative();
  for (const char* name : {"block_sum", "block_count", "fill", "derivative"})
    m.clear(m.word(name)).if_negative();
  m.move(m.nowhere(), m.reg(config::reg_log2_block)).then(Control::load_shift);
  m.move(m.word("blocks_done"), count).floor(variable_shift);
  m.compare(m.word("blocks_done"), m.constant(1));
}

void derivative_block(Assembler& m) {
  m.block("derivative");
  const Word fill = m.word("fill");
  const Word full = m.constant(config::derivative_blocks);
  for (int i = 0; i + 1 < config::derivative_blocks; ++i) m.move(history(m, i), history(m, i + 1));
  m.move(history(m, config::derivative_blocks - 1), m.word("block_sum"));
  m.clear(m.word("block_sum"));
  m.clear(m.word("block_count"));
  m.compare(fill, full);
  m.add(fill, fill, m.constant(1)).if_negative();
  const Word sum = slope_sum(m);
  m.compare(fill, full);
  m.move(m.word("slope_sum"), sum).if_not_negative();
  m.move(m.nowhere(), m.reg(config::reg_slope_shift)).then(Control::load_shift);
  m.move(m.word("slope_word"), sum)
      .round(variable_shift)
      .saturate(config::slope_word)
      .raise(config::status_derivative_saturated)
      .if_not_negative();
  constexpr int fraction =
      config::slope_word.fraction + config::registers[config::reg_slope_gain].format.fraction;
  m.add(m.word("derivative"), m.zero(), m.product(m.word("slope_word"), m.reg(config::reg_slope_gain)))
      .round(fraction - config::derivative.fraction)
      .saturate(config::derivative)
      .raise(config::status_derivative_saturated)
      .if_not_negative();
}

void derivative_state(Assembler& m) {
  m.block("derivative");
  m.move(m.nowhere(), m.word("slope_sum")).send_to(config::tap_slope_sum);
  m.move(m.nowhere(), m.word("derivative")).send_to(config::tap_derivative);
  m.subtract(m.nowhere(), m.word("fill"), m.constant(config::derivative_blocks))
      .raise(config::status_derivative_invalid);
}

}  // namespace hemi::microcode

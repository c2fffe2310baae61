// SPDX-License-Identifier: Apache-2.0
//
// Compiled, not run: as C++14 under the strictest warnings every part of hls/fixed.hpp must pass; with
// HEMI_TOO_WIDE set to 1 to 4, one operation too many is asked for and must be refused.
#include "hls/fixed.hpp"

#ifndef HEMI_TOO_WIDE
#define HEMI_TOO_WIDE 0
#endif

namespace hemi {
namespace hls {

using Full = Fixed<63, 2>;
using Wide = Fixed<62, 1>;
using Word = Fixed<32, 1>;
using Sample = Fixed<16, 1, Round::half_even, Overflow::saturate_symmetric>;

bool use_all(Full full, Wide wide, Word word, Sample sample);

bool use_all(Full full, Wide wide, Word word, Sample sample) {
  const auto sum = wide + wide;
  const auto difference = wide - word;
  const auto product = word * Fixed<31, 1>(word);
  const auto negative = -wide;
  const Sample rounded = quantise<Sample>(product);
  full = wrap_sub(wrap_add(full, sample), scale<-3>(shift_right(sample, 2)));
  return sum < difference || negative >= rounded || full == word || full != wide || word > sample ||
         word <= full || saturates<Sample>(full) || is_negative(from_raw<Full>(raw(full)));
}

#if HEMI_TOO_WIDE == 1
auto refused(Full a, Full b) {
  return a + b;
}
#elif HEMI_TOO_WIDE == 2
auto refused(Word a, Word b) {
  return a * b;
}
#elif HEMI_TOO_WIDE == 3
auto refused(Full a) {
  return -a;
}
#elif HEMI_TOO_WIDE == 4
auto refused(Fixed<40, 40> a, Fixed<24, 0> b) {
  return a - b;
}
#endif

}  // namespace hls
}  // namespace hemi

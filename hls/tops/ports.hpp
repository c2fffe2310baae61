// SPDX-License-Identifier: Apache-2.0
// How the tops' outputs are made known to an HLS compiler, and how a word becomes a port.
//
// With HEMI_HLS_TOOL set, HEMI_TOP_OUTPUT(name) before a function says to PandA Bambu that pointer `name` is
// an output of its own with a valid bit, and HEMI_TOP_OUTPUT_ARRAY that it is a memory of so many words.
// Vitis HLS and Catapult make the same ports of written pointers and arrays without being told.
#ifndef HEMI_HLS_TOPS_PORTS_HPP
#define HEMI_HLS_TOPS_PORTS_HPP

#include "hls/words.hpp"

#define HEMI_TOP_OUTPUT(name) HEMI_HLS_PRAGMA(HLS interface port = name mode = valid)
#define HEMI_TOP_OUTPUT_ARRAY(name, words) \
  HEMI_HLS_PRAGMA(HLS interface port = name mode = array elem_count = words)

namespace hemi {
namespace hls {

/// A raw word of at most 32 bits.
template <class T>
std::int32_t word(const T& x) {
  static_assert(fixed_traits<T>::width <= 32, "this port has 32 bits");
  return static_cast<std::int32_t>(raw(x));
}

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_TOPS_PORTS_HPP

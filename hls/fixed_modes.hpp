// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_HLS_FIXED_MODES_HPP_
#define HEMI_HLS_FIXED_MODES_HPP_

namespace hemi {
namespace hls {

/// What becomes of the fraction bits that a target type has no room for.
enum class Round {
  floor,     ///< towards minus infinity (SC_TRN)
  half_up,   ///< to nearest, halves towards plus infinity (SC_RND)
  half_even  ///< to nearest, halves to the even neighbour (SC_RND_CONV)
};

/// What becomes of a rounded value outside the target's range.
enum class Overflow {
  wrap,               ///< modulo 2^W (SC_WRAP)
  saturate,           ///< to the nearer end of [-2^(W-1), 2^(W-1) - 1] (SC_SAT)
  saturate_symmetric  ///< to the nearer end of [-(2^(W-1) - 1), 2^(W-1) - 1] (SC_SAT_SYM)
};

/// fixed_traits<T>::width, ::integer, ::fraction of a fixed-point type of whichever backend.
template <class T>
struct fixed_traits;

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_FIXED_MODES_HPP_

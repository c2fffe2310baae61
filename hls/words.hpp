// SPDX-License-Identifier: Apache-2.0
// The core's words as types, from the formats of hls/config.hpp, and the hooks that every kernel shares.
#ifndef HEMI_HLS_WORDS_HPP
#define HEMI_HLS_WORDS_HPP

#include "hls/config.hpp"
#include "hls/fixed.hpp"

// One macro for the pragmas of HLS compilers: HEMI_HLS_PRAGMA(HLS pipeline II=1).
#ifdef HEMI_HLS_TOOL
#define HEMI_HLS_PRAGMA(text) _Pragma(#text)
#else
#define HEMI_HLS_PRAGMA(text)
#endif

namespace hemi {
namespace hls {

/// The type of a declared format: plain (floor, wrap), rounding half up, or rounding half up and clipping.
template <const config::Format& F>
using Word = Fixed<F.width, F.width - F.fraction>;
template <const config::Format& F>
using Rounded = Fixed<F.width, F.width - F.fraction, Round::half_up>;
template <const config::Format& F>
using Clipped = Fixed<F.width, F.width - F.fraction, Round::half_up, Overflow::saturate>;
template <int Index>
using RegisterWord = Fixed<config::registers[Index].format.width,
                           config::registers[Index].format.width - config::registers[Index].format.fraction>;

using Phase = Word<config::phase>;
using Increment = Word<config::increment>;
using Sine = Word<config::sine>;
using Product = Word<config::product>;
using Baseband = Word<config::baseband>;
using CordicWord = Word<config::cordic>;
using Angle = Word<config::angle>;
using TickPhase = Word<config::tick_phase>;
using TotalPhase = Word<config::total_phase>;
using Frequency = Word<config::frequency>;
using AmplitudeSum = Word<config::amplitude_sum>;
using PhaseErrorSum = Word<config::phase_error_sum>;
using Command = Word<config::command>;
using CommandIntegral = Word<config::command_integral>;
using CommandSum = Word<config::command_sum>;
using DacWord = Word<config::dac>;
using DacSum = Word<config::dac_sum>;
using RateTick = Word<config::rate_tick>;
using RateAccumulator = Word<config::rate_accumulator>;
using Rate = Word<config::rate>;
using Offset = Word<config::offset>;
using Derivative = Word<config::derivative>;
using Temperature = Word<config::temperature>;
using Bias = Word<config::bias>;

/// Quantises `x` to `Target` by way of `Clip` (the same format, clipping) and raises `flag` when it clips.
template <class Target, class Clip, class Expression>
Target clip(const Expression& x, bool& flag) {
  flag = flag || saturates<Clip>(x);
  return quantise<Target>(quantise<Clip>(x));
}

/// Sum over this output interval and the one before; moves on to the next.
template <class T>
T over_two(T& current, T& last) {
  const T both = wrap_add(current, last);
  last = current;
  current = T();
  return both;
}

/// Listens to no tap; costs nothing.
struct NoProbe {
  template <class T>
  void operator()(config::TapIndex, const T&) {}
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_WORDS_HPP

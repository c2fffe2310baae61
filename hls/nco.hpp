// SPDX-License-Identifier: Apache-2.0
//
// nco: numerically controlled oscillator.
//
//   phase[n+1] = phase[n] + increment (turns, modulo 32);  cos, sin of 2 pi (phase[n] + 2^-25)
//
// in       increment Q1.48 turns a sample
// out      cos, sin Q1.19, full scale +-(1 - 2^-19); spurs <= -115 dBc
// latency  0 samples, interval 1
// rounding phase cut to 24 bits below the turn; interpolation rounded half up to 2^-19; the phase wraps
// source   quarter wave with linear interpolation; docs/chain.md derives the spurs
#ifndef HEMI_HLS_NCO_HPP
#define HEMI_HLS_NCO_HPP

#include "hls/tables.hpp"
#include "hls/words.hpp"

namespace hemi {
namespace hls {

struct SinCos {
  Sine cosine, sine;
};

class Nco {
 public:
  void reset() { phase_ = Phase(); }
  Phase phase() const { return phase_; }
  void advance(const Increment& increment) { phase_ = wrap_add(phase_, increment); }

  SinCos output() const { return look_up(phase_); }

  /// Of any phase; the modulator's carrier comes from the same table.
  static SinCos look_up(const Phase& phase) {
    constexpr int bits = config::table_index_bits + config::table_fine_bits;
    constexpr std::int32_t mask = (std::int32_t{1} << bits) - 1;
    const std::int32_t angle =
        static_cast<std::int32_t>((raw(phase) >> (config::phase.fraction - bits - 2)) & ((mask << 2) | 3));
    const std::int32_t quadrant = angle >> bits;
    const std::int32_t u = angle & mask;
    // Odd quadrants run down the quarter wave: mirrored by the complement.
    const std::int32_t fold = (quadrant & 1) != 0 ? mask : 0;
    const std::int32_t s = quarter(u ^ fold);
    const std::int32_t c = quarter(u ^ fold ^ mask);
    const bool sine_negative = quadrant >= 2;
    const bool cosine_negative = quadrant == 1 || quadrant == 2;
    return {from_raw<Sine>(cosine_negative ? -c : c), from_raw<Sine>(sine_negative ? -s : s)};
  }

 private:
  /// sin of (u + 1/2) / 2^22 of a quarter turn, in 2^-19.
  static std::int32_t quarter(std::int32_t u) {
    constexpr int f = config::table_fine_bits;
    const std::int32_t index = u >> f;
    const std::int32_t fine = ((u & ((1 << f) - 1)) << 1) | 1;
    const std::int32_t step = std::int32_t{sine_delta[index]} * fine;  // below 2^26
    const std::int64_t sum = (std::int64_t{sine_base[index]} << (f + 1)) + step;
    return static_cast<std::int32_t>((sum + (1 << (f + 1))) >> (f + 2));
  }

  Phase phase_;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_NCO_HPP

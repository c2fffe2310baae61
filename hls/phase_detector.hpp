// SPDX-License-Identifier: Apache-2.0
//
// phase_detector: amplitude and phase of the primary by CORDIC vectoring; the secondary rotated by the
// demodulation phase.
//
//   amplitude = K |I + jQ|, phase_error = atan2(Q, I) / (2 pi);  in_phase + j quadrature = (yi + j yq) e^{-j
//   demodulation}
//
// in       baseband Q1.27; cosine and sine of the demodulation phase Q2.22
// out      amplitude Q2.32 with K = prod sqrt(1 + 4^-i) = 1.6468; phase error in turns Q0.32; secondary Q1.27
// latency  within the tick
// rounding CORDIC shifts floor, 24 iterations: angle within 2^-23 rad; the angle wraps at half a turn; the
// secondary rounds half up and clips source   J. E. Volder, The CORDIC trigonometric computing technique,
// 1959
#ifndef HEMI_HLS_PHASE_DETECTOR_HPP
#define HEMI_HLS_PHASE_DETECTOR_HPP

#include "hls/tables.hpp"
#include "hls/words.hpp"

namespace hemi {
namespace hls {

struct Polar {
  CordicWord amplitude;
  Angle phase_error;
};

struct Secondary {
  Baseband in_phase, quadrature;
};

struct PhaseDetector {
  static Polar vectoring(const Baseband& in_phase, const Baseband& quadrature) {
    CordicWord x = quantise<CordicWord>(in_phase);
    CordicWord y = quantise<CordicWord>(quadrature);
    Angle z;
    if (is_negative(x)) {
      x = quantise<CordicWord>(-x);
      y = quantise<CordicWord>(-y);
      z = from_raw<Angle>(-(std::int64_t{1} << (config::angle.width - 1)));
    }
    for (int i = 0; i < config::cordic_iterations; ++i) {
      const CordicWord dx = shift_right(x, i);
      const CordicWord dy = shift_right(y, i);
      const Angle dz = from_raw<Angle>(cordic_angle[i]);
      const bool negative = is_negative(y);
      x = negative ? wrap_sub(x, dy) : wrap_add(x, dy);
      y = negative ? wrap_add(y, dx) : wrap_sub(y, dx);
      z = negative ? wrap_sub(z, dz) : wrap_add(z, dz);
    }
    return {x, z};
  }

  static Secondary rotate(const Baseband& i, const Baseband& q,
                          const RegisterWord<config::reg_demodulation_cos>& c,
                          const RegisterWord<config::reg_demodulation_sin>& s, bool& saturated) {
    return {clip<Baseband, Clipped<config::baseband>>(i * c + q * s, saturated),
            clip<Baseband, Clipped<config::baseband>>(q * c - i * s, saturated)};
  }
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_PHASE_DETECTOR_HPP

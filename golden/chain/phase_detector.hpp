// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/chain/cic.hpp"

namespace hemi::golden {

/// Product of sqrt(1 + 4^-i), i = 0..23: what the CORDIC rotations lengthen a vector by.
double cordic_gain();

struct Polar {
  double amplitude;    ///< K |(I, Q)|
  double phase_error;  ///< atan2(Q, I), turns in [-1/2, 1/2)
};

/// Ideal: the functions themselves. Quantised: CORDIC vectoring, both coordinates and the angle in steps of
/// 2^-32.
Polar polar(const Arithmetic& arithmetic, double in_phase, double quadrature);

struct Secondary {
  double in_phase;
  double quadrature;
  bool clipped;
};

/// (yi c + yq s, yq c - yi s): the secondary turned back by the demodulation phase, (c, s) = (cos, sin) of
/// it.
Secondary rotate(const Arithmetic& arithmetic, double yi, double yq, double c, double s);

}  // namespace hemi::golden

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/concealed/instrument.hpp"

namespace hemi::concealed {

/// Rate-independent memory of x, scaled to a peak-to-peak value of 1 over the recording `first`, whose range
/// x is scaled to as well; 0 where that never moves. `opening`: largest difference between the ways up and
/// down over the full range, at the same scale; the peak-to-peak value holds a function of x alone besides.
struct Memory {
  Series along;
  double opening = 0.0;
};

/// Preisach: relays over a bell-shaped density of thresholds; `width` mean half-width of a relay, `spread` of
/// the density, both as share of x's half range. Starts with the relays below the start up, the others down.
Memory preisach(const Series& x, const Series& first, double width, double spread);

/// Duhem: dy = c (dx - y |dx|), x scaled to [-1, 1].
Memory duhem(const Series& x, const Series& first, double c);

/// Bouc-Wen: dz = c (dx - (b |dx| z |z| + (1 - b) dx z^2)), x scaled to [-1, 1], 0.5 < b <= 1.
Memory bouc_wen(const Series& x, const Series& first, double c, double b);

}  // namespace hemi::concealed

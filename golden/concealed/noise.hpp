// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/concealed/instrument.hpp"

namespace hemi::concealed {

/// One-sided power spectral density [unit^2/Hz] at f > 0 of one-second telemetry:
/// white^2 + flicker^2/f + random_walk^2/f^2 + (differenced sin(pi f)/pi)^2.
double density(const NoiseLevel& level, double frequency_hz);

/// A realisation, one value a second. Coloured parts are shaped in the frequency domain on a grid of at least
/// twice the length, so that start and end do not know of each other.
Series noise(const NoiseLevel& level, Eigen::Index count, Random& random);

}  // namespace hemi::concealed

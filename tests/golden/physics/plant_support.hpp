// SPDX-License-Identifier: Apache-2.0
// Instruments and configurations that several tests of the plant start from.
#pragma once

#include "golden/physics/plant.hpp"

namespace hemi::physics::testing {

/// Without noise.
inline Instrument silent() {
  Instrument instrument;
  instrument.pickoff_noise_lsb = 0.0;
  instrument.force_noise_dph_rthz = 0.0;
  return instrument;
}

/// Nominal scales, but neither damping nor mismatch nor split.
inline Parameters lossless(const Instrument& instrument) {
  Parameters p = instrument.at(20.0);
  p.damping_per_s = p.mismatch_cos_per_s = p.mismatch_sin_per_s = p.split_cos_rad_s = p.split_sin_rad_s = 0.0;
  return p;
}

/// The primary at nominal amplitude, phase 0.
inline PlantConfiguration ringing(AdcConfiguration adc = AdcConfiguration::reference()) {
  PlantConfiguration configuration;
  configuration.adc = adc;
  configuration.start = {1.0, 0.0, 0.0, 0.0};
  return configuration;
}

}  // namespace hemi::physics::testing

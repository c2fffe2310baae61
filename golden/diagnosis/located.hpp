// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "golden/diagnosis/telemetry_diagnosis.hpp"

namespace hemi::diagnosis {

/// Where the misfit of one output lies.
struct Located {
  Output output = Output::rate;
  double share = 0.0;  ///< of the misfit of all outputs, each in units of its noise
  std::vector<std::pair<double, double>>
      time_s;            ///< stretches that hold nine tenths of it, from the first row
  std::string variable;  ///< input whose range holds it
  double low = 0.0, high = 0.0;
  std::string when;                    ///< "heating", "cooling" or "always"
  double low_hz = 0.0, high_hz = 0.0;  ///< band that holds nine tenths of it
};

/// The misfit is what effects, free functions, colour beyond the stated one, lines and slips take off beside
/// the baseline, in deviations of the expected noise (squares of the whitened rows); less than a hundredth of
/// the whole is left out. Stretches are made of windows of 300 s from the first row. Largest share first.
std::vector<Located> locate(const TelemetryDiagnosis& diagnosis);

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "golden/diagnosis/telemetry_diagnosis.hpp"

namespace hemi::diagnosis {

/// How much of an effect the core can take off: its rate compensation is a function of the counted frequency
/// and its derivative, its thermometer one of the frequency alone. Shares of the variance of the effect's
/// trace, each on four contiguous blocks that the projection has not seen; 0 to 1.
struct CoreShare {
  std::string effect;
  bool traced = false;        ///< no line, pulse or noise, which have no course that could be projected
  bool in_rate = false;       ///< at rest it moves the rate, or the rate that the core takes off
  bool in_frequency = false;  ///< at rest it moves the frequency at one and the same temperature
  double rate = 0.0;
  double temperature = 0.0;
};

/// Share below which an effect is not said to be compensated: what blocks left out do not confirm is chance.
inline constexpr double kLeastCoreShare = 0.1;

/// How the core is run.
struct CoreOperation {
  double derivative_late_s = 0.0;  ///< df/dt behind the frequency
  double amplitude = 1.0;          ///< set point
};

struct CoreCorrection {
  NominalModel model;  ///< the corrected one; f(T) and bias carry what the core can take off
  double low_degc = 0.0, high_degc = 0.0;  ///< resonator temperatures of the recording
  bool frequency_changed = false;          ///< f(T) holds an effect, and is valid from low to high only
  std::vector<CoreShare> shares;           ///< of what is named, in that order
  Eigen::VectorXd driven_dph;  ///< what the named effects do to the rate beyond what they do at rest
};

/// Projects what the corrected model does to the rate onto the ten terms of Eq. (21), and what it does to the
/// frequency onto a polynomial of fifth order in the resonator's temperature. The trajectory is the
/// recording's as the corrected model simulates it, so that none of its noise comes in, and at rest:
/// amplitude at its set point, supply and attitude at their medians, neither turning nor trimmed, since the
/// core knows of none of these. Terms that the trajectory cannot tell apart are shrunk (project), since
/// another trajectory would multiply them. Of the named effects those go in with which the whole change of
/// the rate, moved parameters included, is predicted best where it was left out; where nothing predicts it
/// better than the bias as `given`, that one stays.
CoreCorrection core_correction(const TelemetryDiagnosis& result, const NominalModel& given,
                               const CoreOperation& operation);

/// What a named effect, as fitted, does along another simulation; empty where its inputs are at rest there.
Trace effect_along(const TelemetryDiagnosis& result, const Explanation& effect, const Simulation& other);

/// Rate of the corrected model along the recording, named effects included [deg/h].
Eigen::VectorXd corrected_rate(const TelemetryDiagnosis& result);

}  // namespace hemi::diagnosis

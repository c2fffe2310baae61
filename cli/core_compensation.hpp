// SPDX-License-Identifier: Apache-2.0
// What a diagnosis gives back to the core: a model in the core's own terms, and the core's compensation with
// it.
#ifndef HEMI_CLI_CORE_COMPENSATION_HPP
#define HEMI_CLI_CORE_COMPENSATION_HPP

#include <Eigen/Core>

#include "cli/recording/model.hpp"
#include "golden/diagnosis/core_correction.hpp"

namespace hemi::cli {

/// How far the core's df/dt is behind at its own rate [s]: half of its window, and half of a block, for which
/// the value is held.
double core_derivative_late_s();

/// The model with f(T), bias and scale factor as the core is to have them; no effects.
recording::InstrumentModel core_model(const recording::InstrumentModel& corrected,
                                      const diagnosis::CoreCorrection& correction);

/// What the core makes of telemetry, a row each; NaN where a channel is missing.
struct CoreRun {
  Eigen::VectorXd residual_dph;  ///< compensated rate less the applied one; NaN until df/dt fills its window
  Eigen::VectorXd temperature_degc;
};

/// Telemetry (frequency and rate) through the hls engine's thermometer, derivative and bias model, registers
/// quantised. InputError for a model that the registers cannot hold, tb::FormatError for telemetry that the
/// words cannot.
CoreRun run_core(const diagnosis::Telemetry& telemetry, const recording::InstrumentModel& model);

}  // namespace hemi::cli

#endif  // HEMI_CLI_CORE_COMPENSATION_HPP

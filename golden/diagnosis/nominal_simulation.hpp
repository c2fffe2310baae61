// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "golden/diagnosis/series.hpp"
#include "golden/diagnosis/telemetry.hpp"

namespace hemi::diagnosis {

/// What something changes in the outputs, rows of the telemetry; empty where it changes nothing.
struct Trace {
  std::array<Eigen::VectorXd, kOutputs.size()> outputs;

  Eigen::VectorXd& operator[](Output output) { return outputs[place(output)]; }
  const Eigen::VectorXd& operator[](Output output) const { return outputs[place(output)]; }
};

/// sum_i c_i columns_i, empty where all are.
Trace summed(const std::vector<Trace>& columns, const Eigen::VectorXd& coefficients);

/// The ten terms of the bias model over f (already less its reference) and df, in their order.
std::array<Eigen::ArrayXd, kBiasTermCount> bias_terms(const Eigen::ArrayXd& f, const Eigen::ArrayXd& df);

/// What the model's bias makes of them [deg/h].
Eigen::ArrayXd bias_dph(const NominalModel& model, const Eigen::ArrayXd& f, const Eigen::ArrayXd& df);

/// Where the resonator is when rows begin, which the case does not tell.
struct Unsettled {
  double start_degc = 0.0;           ///< T less what follows from the case, at the first row
  std::vector<double> restart_degc;  ///< at the first row after each stretch without rows; missing: zero
};

/// A stretch without rows inside a recording.
struct Restart {
  Eigen::Index row = 0, missing = 0;  ///< the first row afterwards; length of the stretch
  Eigen::ArrayXd fading;              ///< exp(-(t - t_row) / tau) of T less what follows from the case
};
std::vector<Restart> restarts(const Telemetry& telemetry, double tau_s);

/// The nominal simulation of the recording format along one recording, and its derivatives.
///
///     T[0] = case[0] + start, T behind the case by one time constant; frequency = p(T);
///     drive = amplitude p_D(T); quadrature = amplitude p_Q(T) + trim; rate = scale rate_in + B(f, df)
inline constexpr double kSmoothing_s = 150.0;
/// A case that moves by less shows its thermometer's noise: of a polynomial in it only the linear term is
/// free.
inline constexpr double kLeastSwing_degc = 1.0;
struct Simulation {
  const Telemetry* telemetry = nullptr;
  NominalModel model;
  Unsettled unsettled;
  Eigen::ArrayXd time_s;  ///< from the first row
  Eigen::ArrayXd temperature_degc;
  /// Thermometers without their noise and steps, smoothed over kSmoothing_s: what an effect makes of T must
  /// not carry the noise that the nominal simulation has made of it.
  Eigen::ArrayXd board_degc, smooth_case_degc, smooth_degc, smooth_f;
  Eigen::ArrayXd smooth_amplitude;    ///< running median: without its noise, its steps where they are
  Eigen::ArrayXd f, df;               ///< frequency less the bias model's reference [Hz], [Hz/s]
  Eigen::ArrayXd frequency_per_degc;  ///< df/dT
  Eigen::ArrayXd rate_per_f, rate_per_df;
  Trace nominal;

  /// Change of all outputs when the resonator is warmer by `warmer` (linear, the frequency exact).
  Trace thermal(const Eigen::ArrayXd& warmer) const;
  /// Change of all outputs when the true frequency is higher by `higher`.
  Trace frequency(const Eigen::ArrayXd& higher) const;
};
/// Thrown by simulate where a model's effect has not as many numbers as its form.
struct BadEffect : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};
Simulation simulate(const Telemetry& telemetry, const NominalModel& model, const Unsettled& unsettled = {});

/// A parameter of the nominal model and what a unit of it changes.
struct BaselineColumn {
  std::string name;  ///< path in the model file, such as frequency.coefficients_hz[1]
  Trace trace;
  double prior_sd = 0.0;  ///< 0: free; else a nuisance that is known to about this much
  bool nuisance = false;  ///< no parameter of the model: start temperature, again after a stretch
                          ///< without rows, lag below one sample
};
/// Free parameters: all of the model's, all ten terms of its bias.
std::vector<BaselineColumn> baseline_columns(const Simulation& simulation);

/// Value of the parameter of that name; zero for a nuisance.
double parameter(const NominalModel& model, const std::string& name);

/// The model with parameters moved by `steps` (order of baseline_columns); where it begins as well.
void move_parameters(const std::vector<BaselineColumn>& columns, const Eigen::VectorXd& steps,
                     NominalModel& model, Unsettled& unsettled);

}  // namespace hemi::diagnosis

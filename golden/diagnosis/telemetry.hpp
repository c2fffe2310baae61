// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace hemi::diagnosis {

/// Channels that a nominal simulation predicts; amplitude is an input to it.
enum class Output { frequency, drive, quadrature, rate };
inline constexpr std::array<Output, 4> kOutputs = {Output::frequency, Output::drive, Output::quadrature,
                                                   Output::rate};
inline constexpr std::array<std::string_view, 4> kOutputNames = {"frequency_hz", "drive_v", "quadrature_v",
                                                                 "rate_dph"};
inline constexpr std::array<std::string_view, 4> kOutputUnits = {"Hz", "V", "V", "deg/h"};
inline std::size_t place(Output output) {
  return static_cast<std::size_t>(output);
}

/// Telemetry of a gyro, channels as in the recording format, equally spaced, one row a sample. Inputs are
/// complete and have a row each (a channel that was not recorded holds its rest value and is not in `given`);
/// outputs are empty where they were not recorded, and NaN where a value is missing.
struct Telemetry {
  double step_s = 1.0;
  Eigen::VectorXd case_degc, board_degc, rate_in_dph, accel_g, supply_v, trim_v, amplitude;
  /// False in stretches without any output that are long enough for a power cut.
  Eigen::Array<bool, Eigen::Dynamic, 1> powered;
  bool has_case = true, has_board = false, has_accel = false, has_supply = false;
  std::array<Eigen::VectorXd, kOutputs.size()> outputs;

  Eigen::Index rows() const { return case_degc.size(); }
  bool has(Output output) const { return outputs[place(output)].size() > 0; }
  const Eigen::VectorXd& operator[](Output output) const { return outputs[place(output)]; }
};

/// Ascending polynomial in (x - reference).
struct Polynomial {
  double reference = 0.0;
  std::vector<double> coefficients;

  Eigen::ArrayXd at(const Eigen::ArrayXd& x) const;
  Eigen::ArrayXd slope(const Eigen::ArrayXd& x) const;
};

/// Number of terms of the bias model, in the order 1, f, f^2, f^3, df, df^2, df^3, f*df, f^2*df, f*df^2.
inline constexpr std::size_t kBiasTermCount = 10;

/// An effect that a model has already: a form that the diagnosis knows, with its numbers.
struct GivenEffect {
  std::string effect, form;
  std::vector<double> shape, coefficients;
};

/// All that the nominal simulation is told about one instrument: `hemi-model/1`.
struct NominalModel {
  Polynomial frequency_hz;  ///< of the resonator's temperature [degC]
  double time_constant_s = 2000.0;
  double bias_reference_hz = 0.0;
  std::array<double, kBiasTermCount> bias_dph{};
  double scale_factor = 1.0;
  Polynomial drive_v, quadrature_v;  ///< per unit of amplitude
  /// Colour that the model states: one-sided amplitude densities at 1 Hz of 1/f noise, and a walk per root
  /// second.
  struct Colour {
    double flicker = 0.0, walk = 0.0;
  };
  std::array<Colour, kOutputs.size()> noise;
  /// One whose form this recording cannot show (its input does not move or is not recorded) does nothing
  /// here.
  std::vector<GivenEffect> effects;
};

}  // namespace hemi::diagnosis

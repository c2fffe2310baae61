// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace hemi::rivals {

/// Telemetry of one recording in equal steps; an empty series was not recorded.
struct Telemetry {
  double step_s = 1.0;
  Eigen::VectorXd time_s, case_degc, board_degc, rate_in_dph, accel_g, supply_v, trim_v;
  Eigen::VectorXd frequency_hz, amplitude, drive_v, quadrature_v, rate_dph;
};

/// The numbers of the nominal simulation; bias terms in the order 1 f f^2 f^3 df df^2 df^3 f*df f^2*df
/// f*df^2.
struct Numbers {
  double frequency_reference_degc = 0.0, time_constant_s = 0.0, bias_reference_hz = 0.0, scale_factor = 1.0;
  double drive_reference_degc = 0.0, quadrature_reference_degc = 0.0;
  std::vector<double> frequency_hz, drive_v, quadrature_v;
  std::array<double, 10> bias_dph{};
};

/// A standard form: one or more columns that come and go together.
struct Candidate {
  std::string id;
  Eigen::MatrixXd columns;
};

/// One output as a regression: misfit = base * a + candidates * b + noise.
struct Problem {
  std::string channel;
  Eigen::VectorXd misfit;  ///< recorded less nominal
  Eigen::MatrixXd base;    ///< sensitivities to the nominal model's own numbers
  std::vector<Candidate> candidates;
  Eigen::MatrixXd
      inputs;  ///< for methods without a library: T, dT/dt, t, Tb, A, V, W, a, Q (constant where absent)
};
inline const std::vector<std::string> kInputs = {"T", "dT", "t", "Tb", "A", "V", "W", "a", "Q"};

/// The four outputs that are there, averaged over `average` samples; rows with missing values left out.
/// std::invalid_argument without time_s, case_degc or any output.
std::vector<Problem> problems(const Telemetry& telemetry, const Numbers& numbers, int average);

}  // namespace hemi::rivals

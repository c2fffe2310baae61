// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

namespace hemi::calibration {

/// One monomial f^a (df/dt)^b of the paper's Eq. (21); f: frequency minus its reference [Hz], df/dt [Hz/s].
struct DriftTerm {
  std::string_view name;  ///< as in a model file's terms_dph
  int frequency_power;
  int slope_power;

  /// f^a df^b; unit Hz^(a+b) s^-b.
  double value(double frequency_hz, double slope_hz_per_s) const;
};

inline constexpr std::size_t kDriftTermCount = 10;

/// All ten terms of Eq. (21), in the order of the equation; the first is the constant.
inline constexpr std::array<DriftTerm, kDriftTermCount> kDriftTerms = {{
    {"1", 0, 0},
    {"f", 1, 0},
    {"f^2", 2, 0},
    {"f^3", 3, 0},
    {"df", 0, 1},
    {"df^2", 0, 2},
    {"df^3", 0, 3},
    {"f*df", 1, 1},
    {"f^2*df", 2, 1},
    {"f*df^2", 1, 2},
}};

/// Rows x ten: kDriftTerms of f [Hz] and df/dt [Hz/s].
Eigen::MatrixXd drift_design(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& slope_hz_per_s);

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hemi::diagnosis {

/// A recording that holds only the case's temperature and the rate, rows equally spaced or nearly so, no
/// value missing.
struct CaseRows {
  Eigen::VectorXd time_s;
  Eigen::VectorXd case_degc;
  Eigen::VectorXd rate_dph;
};

/// First-order node: x' = (T - x) / tau, x[0] = T[0], exact for a temperature held over each step.
Eigen::VectorXd node_degc(const Eigen::VectorXd& time_s, const Eigen::VectorXd& degc, double tau_s);

/// Play operator of threshold r [degC]: p[i] = clamp(p[i-1], T[i] - r, T[i] + r), p[0] = T[0]. Depends on the
/// direction of the temperature, never on its speed. Source: Visintin, Differential Models of Hysteresis.
Eigen::VectorXd play_degc(const Eigen::VectorXd& degc, double threshold_degc);

/// All columns that the families of memory draw on, for one assumption about the time before the first row:
/// the first rows' slope had lasted for `before_s`. u = (T - middle) / half range of the case's temperature.
struct MemoryColumns {
  static constexpr Eigen::Index kDegrees = 6;  ///< u^0 .. u^5
  static constexpr Eigen::Index kNodes = 5;    ///< time constants: duration / 4^k
  static constexpr Eigen::Index kPlays = 5;    ///< thresholds: half range / 2^(k + 1)
  static constexpr Eigen::Index kDrifts = 3;   ///< t, exp(-t / duration), exp(-4 t / duration)
  static constexpr Eigen::Index kPairs = kNodes * (kNodes + 1) / 2;  ///< one pole, or two in series
  static constexpr Eigen::Index kCube = 3;                           ///< powers 1 .. 3 of each pair

  Eigen::MatrixXd values;  ///< rows x count()
  double middle_degc = 0.0, half_degc = 1.0;
  std::vector<double> tau_s, threshold_degc;

  static Eigen::Index power(Eigen::Index degree) { return degree; }
  /// (T - node k) / half range.
  static Eigen::Index lag(Eigen::Index k) { return kDegrees + k; }
  /// (T - play k) / half range, times u^times (0 or 1).
  static Eigen::Index play(Eigen::Index k, Eigen::Index times) {
    return kDegrees + kNodes + times * kPlays + k;
  }
  static Eigen::Index drift(Eigen::Index k, Eigen::Index times) {
    return kDegrees + kNodes + 2 * kPlays + times * kDrifts + k;
  }
  /// Power 1 .. 3 of the temperature behind pair `p`, scaled as u is.
  static Eigen::Index two_poles(Eigen::Index pair, Eigen::Index degree) {
    return kDegrees + kNodes + 2 * kPlays + 2 * kDrifts + pair * kCube + degree - 1;
  }
  static constexpr Eigen::Index count() {
    return kDegrees + kNodes + 2 * kPlays + 2 * kDrifts + kPairs * kCube;
  }
};

/// Throws std::invalid_argument for fewer than 256 rows or a temperature that does not move.
MemoryColumns memory_columns(const CaseRows& rows, double before_s);

}  // namespace hemi::diagnosis

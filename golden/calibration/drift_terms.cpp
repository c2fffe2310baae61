// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/drift_terms.hpp"

#include <stdexcept>

namespace hemi::calibration {

double DriftTerm::value(double frequency_hz, double slope_hz_per_s) const {
  double product = 1.0;
  for (int i = 0; i < frequency_power; ++i) product *= frequency_hz;
  for (int i = 0; i < slope_power; ++i) product *= slope_hz_per_s;
  return product;
}

Eigen::MatrixXd drift_design(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& slope_hz_per_s) {
  if (frequency_hz.size() != slope_hz_per_s.size()) {
    throw std::invalid_argument("drift terms: as many frequencies as slopes are needed");
  }
  Eigen::MatrixXd design(frequency_hz.size(), static_cast<Eigen::Index>(kDriftTermCount));
  for (std::size_t term = 0; term < kDriftTermCount; ++term) {
    for (Eigen::Index row = 0; row < frequency_hz.size(); ++row) {
      design(row, static_cast<Eigen::Index>(term)) =
          kDriftTerms[term].value(frequency_hz(row), slope_hz_per_s(row));
    }
  }
  return design;
}

}  // namespace hemi::calibration

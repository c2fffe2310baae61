// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "golden/calibration/frequency_polynomial.hpp"

namespace hemi::calibration {

/// F-test of a polynomial against one with more terms: F = (S_n - S_m) / (m - n) / (S_m / dof_m).
struct OrderTest {
  Eigen::Index against_order;  ///< m
  double f_statistic;
  double p_value;
};

/// What the settled points say about one order.
struct OrderReport {
  FrequencyFit fit;
  std::optional<OrderTest> next;          ///< against the next order, where that has a degree of freedom left
  std::optional<OrderTest> next_but_one;  ///< against the next two together
  std::optional<double> chi_square;       ///< residuals against the table's rounding, where that is known
  std::optional<double> chi_square_p;     ///< approximate: rounding errors are uniform, not normal
  Eigen::VectorXd leave_one_out_degc;     ///< one a point
  double leave_one_out_max_degc;          ///< largest magnitude; NaN where any point cannot be inverted
};

/// Every order that the points can be tested for, the one they support, and why.
struct OrderStudy {
  std::vector<OrderReport> orders;  ///< order 1, 2, ...
  Eigen::Index chosen = 1;
  double rounding_hz = 0.0;  ///< half a step of the printed frequencies; 0 where unknown
  std::string verdict;       ///< sentences, one a line

  const OrderReport& report(Eigen::Index order) const {
    return orders.at(static_cast<std::size_t>(order - 1));
  }
};

/// Chooses the lowest order that neither the next order nor the next two together improve significantly
/// (F-test at 5 %); two, because a term of even or odd order alone can be missing. Each order keeps one
/// degree of freedom and can be judged with every point left out in turn, so order + 2 points are needed; at
/// most order 6 is tried. Throws std::invalid_argument on fewer than three points or three different
/// temperatures.
OrderStudy study_order(const SettledPoints& points, double reference_degc = 0.0);

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "golden/calibration/order_study.hpp"
#include "golden/diagnosis/bench_diagnosis.hpp"
#include "golden/diagnosis/block_statistics.hpp"

namespace hemi::diagnosis {

/// One order of f(T) against what the table's rounding can do.
struct TableOrder {
  Eigen::Index order;
  double rms_hz, max_hz;
  double log10_p = 0.0;     ///< chi-square of the residuals over the rounding's variance; 0 where unknown
  double minimax_hz = 0.0;  ///< least possible largest residual of any polynomial of this order
  double left_out_rms_hz, left_out_max_degc;  ///< every point predicted by a fit to all the others
};

/// What a table of settled points says about the order of f(T).
struct TableDiagnosis {
  Verdict verdict = Verdict::consistent;
  Eigen::Index baseline = 3, chosen = 3;
  double rounding_rms_hz = 0.0;  ///< step / sqrt 12; 0 where the table shows no step
  std::vector<TableOrder> orders;
  Gain train, left_out;                 ///< baseline to chosen [Hz]; bootstrap over the points
  double f_statistic = 0.0, f_p = 1.0;  ///< of the order after the baseline's against the baseline
  double top_coefficient = 0.0, top_half_width95 = 0.0;  ///< of the chosen order [Hz/degC^order]
  double ppm_span = 0.0;            ///< chosen minus baseline, peak to peak over the range
  double residual_degc = 0.0;       ///< the baseline's residuals read as temperatures, rms
  double chamber_error_degc = 0.0;  ///< scatter of the soaks' temperatures that would explain the baseline
  double smallest_top = 0.0;  ///< strength of the order after the baseline's seen at five sigma of rounding
  double smallest_ppm = 0.0;  ///< the same as a span of frequency
  calibration::OrderStudy study;

  const TableOrder& at(Eigen::Index order) const { return orders.at(static_cast<std::size_t>(order - 1)); }
};

/// Judges the table against a polynomial of order `baseline`, 3 being the paper's Eq. (18). consistent: the
/// baseline is not rejected, neither by the rounding (1 %) nor by a higher order (F-test, 1 %). ambiguous: it
/// is rejected and a higher order is supported, which the resonator, the counting oscillator and the chamber
/// can each cause. unknown: it is rejected and no order that can be tested repairs it. Throws
/// std::invalid_argument where study_order does, or where it cannot test order `baseline` + 1.
TableDiagnosis diagnose_table(const calibration::SettledPoints& points, Eigen::Index baseline = 3);

/// log10 of P(chi-square on dof > x), also where the probability itself underflows.
double log10_chi_square_tail(double x, double dof);

/// Least largest residual of any polynomial of the given order, by the levelled error of every order + 2
/// points; a table of more than 20 points is taken in stretches of 20, which gives a lower bound. Source: de
/// la Vallee Poussin; Cheney, Introduction to Approximation Theory, chapter 2.
double minimax_residual(const Eigen::VectorXd& x, const Eigen::VectorXd& y, Eigen::Index order);

}  // namespace hemi::diagnosis

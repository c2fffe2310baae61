// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/stage_coupling.hpp"

#include <Eigen/QR>
#include <cmath>

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// What the averaged equations leave out beyond the term that is taken off: a few per cent of K/(2 w) = 4e-3
// at a rebalance loop of 40 Hz. Size from captures with nothing left out (docs/stage.md).
constexpr double kAveragedAway_rad = 3e-4;
constexpr Index kPolynomial = 4;  // constant to cubic: temperature, and what it does to the frequency

MatrixXd slow_columns(Index rows) {
  MatrixXd columns(rows, kPolynomial);
  for (Index i = 0; i < rows; ++i) {
    const double u = 2.0 * static_cast<double>(i) / static_cast<double>(rows - 1) - 1.0;
    for (Index k = 0; k < kPolynomial; ++k) columns(i, k) = std::pow(u, static_cast<double>(k));
  }
  return columns;
}

// Integral up to the middle of each block.
VectorXd integral(const VectorXd& values, double seconds) {
  VectorXd sum(values.size());
  double total = 0.0;
  for (Index i = 0; i < values.size(); ++i) {
    sum[i] = total + 0.5 * values[i] * seconds;
    total += values[i] * seconds;
  }
  return sum;
}

// What is left of a column beside the others.
VectorXd beside(const MatrixXd& others, const VectorXd& column) {
  return column - others * others.colPivHouseholderQr().solve(column);
}

MatrixXd with(const MatrixXd& columns, const VectorXd& more) {
  MatrixXd wider(columns.rows(), columns.cols() + 1);
  wider << columns, more;
  return wider;
}

// Coefficient of `column` beside `others`. The noise is the larger of what theory says and what is left, so
// that a motion that no column describes widens the interval instead of making a finding.
Estimate coefficient(const VectorXd& response, const MatrixXd& others, const VectorXd& column, double noise) {
  const VectorXd own = beside(others, column);
  const double squares = own.squaredNorm();
  if (!(squares > 1e-12 * column.squaredNorm())) return {};
  const double value = own.dot(response) / squares;
  const VectorXd left = beside(with(others, column), response);
  const double rms = std::sqrt(left.squaredNorm() / static_cast<double>(left.size() - others.cols() - 1));
  return {value, std::max(rms, noise) / std::sqrt(squares)};
}

// A force that is switched on leaves a constant behind, which depends on the phase of that instant: a step
// there, and the blocks on both sides by themselves.
MatrixXd with_switch(const MatrixXd& columns, const VectorXd& force) {
  Index at = 1;
  for (Index i = 1; i < force.size(); ++i)
    if (std::abs(force[i] - force[i - 1]) > std::abs(force[at] - force[at - 1])) at = i;
  MatrixXd wider = MatrixXd::Zero(columns.rows(), columns.cols() + 3);
  wider.leftCols(columns.cols()) = columns;
  wider(at - 1, columns.cols()) = wider(at, columns.cols() + 1) = 1.0;
  wider.col(columns.cols() + 2).tail(columns.rows() - at).setOnes();
  return wider;
}

// What Re Y has put into Im Y because the frame, the primary's phase, does not turn evenly: integral(Re Y
// dphase). An even turn is the column of the split's other axis.
VectorXd turned_by_frame(const Blocks& b) {
  const Index rows = b.phase_rad.size(), half = rows / 2;
  const double mean_turn = (b.phase_rad[rows - 1] - b.phase_rad[half]) / static_cast<double>(rows - 1 - half);
  VectorXd sum = VectorXd::Zero(rows);
  for (Index i = 1; i < rows; ++i)
    sum[i] = sum[i - 1] + 0.5 * (b.secondary[i].real() + b.secondary[i - 1].real()) *
                              (b.phase_rad[i] - b.phase_rad[i - 1] - mean_turn);
  return sum;
}

}  // namespace

Estimate leak(const VectorXd& rest_lsb, const VectorXd& words, double noise_lsb) {
  const double squares = words.squaredNorm();
  if (!(squares > 0.0)) return {};
  return {rest_lsb.dot(words) / squares, noise_lsb / std::sqrt(squares)};
}

Estimate secondary_phase_rad(const Blocks& b, double rebalance_per_s) {
  MatrixXd others = with_switch(slow_columns(b.secondary.size()), b.rebalance.real());
  for (const VectorXd& column :
       {b.amplitude, VectorXd(b.quadrature.cwiseProduct(b.amplitude)), VectorXd(b.secondary.real()),
        VectorXd(b.rebalance.imag()), VectorXd(b.drive.imag())})
    others = with(others, integral(column, b.seconds));
  const VectorXd response =
      b.secondary.imag() - rebalance_per_s / (2.0 * b.omega_rad_s) * b.rebalance.real() + turned_by_frame(b);
  Estimate estimate = coefficient(response, others, b.secondary.real(), b.secondary_noise);
  if (estimate.sigma > 0.0) estimate.sigma = std::hypot(estimate.sigma, kAveragedAway_rad);
  return estimate;
}

Estimate drive_force_rad(const Blocks& b, double drive_per_s) {
  MatrixXd others = slow_columns(b.phase_rad.size());
  for (const VectorXd& column :
       {VectorXd(b.secondary.real()), VectorXd(b.secondary.imag()), VectorXd(b.drive.imag()),
        VectorXd(b.quadrature.cwiseProduct(b.secondary.real()))})
    others = with(others, integral(column.cwiseQuotient(b.amplitude), b.seconds));
  const VectorXd direct = b.drive.real().cwiseQuotient(b.amplitude);
  const VectorXd pushed = drive_per_s * integral(direct, b.seconds);
  return coefficient(b.phase_rad, with(others, direct), pushed, b.primary_noise_rad);
}

}  // namespace hemi::diagnosis

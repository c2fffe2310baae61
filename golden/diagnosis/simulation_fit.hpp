// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "golden/calibration/rows.hpp"
#include "golden/diagnosis/bench_simulation.hpp"

namespace hemi::diagnosis {

/// Contiguous blocks of almost equal length that cover `rows` rows.
std::vector<calibration::RowRange> equal_blocks(Eigen::Index rows, Eigen::Index count);

/// A model fitted by its simulation error.
struct SimulationFit {
  BenchForm form;
  Eigen::VectorXd parameters;
  Eigen::MatrixXd covariance;  ///< of the parameters, from the scatter of the blocks' scores
  Eigen::VectorXd residual;    ///< displacement less free run [V]
  Eigen::MatrixXd jacobian;    ///< derivatives of the free run by the parameters
  bool converged = false;
  double rms() const;
  /// Half width of the 95 % interval: Student's t with the number of blocks less one.
  double half_width95(Eigen::Index place, Eigen::Index blocks) const;
};

/// Least squares of displacement less free run over the rows, by Levenberg and Marquardt with columns scaled
/// to unit norm, from `start`. Covariance: (J'J)^-1 (sum over blocks g g') B / (B - 1) (J'J)^-1, g = J' r of
/// a block, which holds whatever the colour of the residual as long as it is short against a block. `tick` is
/// called once an evaluation and may throw. Source: Seber and Wild, Nonlinear Regression, chapter 14.
SimulationFit fit_simulation(const BenchInput& input, const Eigen::VectorXd& displacement_v,
                             const BenchForm& form, const Eigen::VectorXd& start,
                             const std::vector<calibration::RowRange>& blocks,
                             const std::function<void()>& tick);

/// Residuals of the free run in which every fold is predicted by parameters fitted to the other folds: the
/// state is carried through the fold, its own rows have no part in the parameters. The fit without a fold is
/// one step of Gauss and Newton from the fit with all rows.
Eigen::VectorXd held_out_residual(const BenchInput& input, const Eigen::VectorXd& displacement_v,
                                  const SimulationFit& fit, const std::vector<calibration::RowRange>& folds,
                                  const std::function<void()>& tick);

/// One step of Gauss and Newton with some rows only: parameters that these rows alone would choose. NaN where
/// they do not determine them.
Eigen::VectorXd parameters_from(const SimulationFit& fit, const std::vector<calibration::RowRange>& rows);

}  // namespace hemi::diagnosis

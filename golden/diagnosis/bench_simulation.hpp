// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "golden/diagnosis/bench_terms.hpp"
#include "golden/diagnosis/input_hold.hpp"

namespace hemi::diagnosis {

/// Places in a parameter vector; strengths of the terms follow in their order, then the state at the first
/// row.
inline constexpr Eigen::Index kGain = 0;       ///< b [1/s^2]
inline constexpr Eigen::Index kDamping = 1;    ///< d [1/s]
inline constexpr Eigen::Index kStiffness = 2;  ///< k1 [1/s^2]
inline constexpr Eigen::Index kConstant = 3;   ///< c [V/s^2]
inline constexpr Eigen::Index kLinear = 4;

/// y'' + d y' + k1 y + sum strength_j shape_j(y, y', u) = b u + c.
struct BenchForm {
  std::vector<Term> terms{};
  Eigen::Index size() const { return kLinear + static_cast<Eigen::Index>(terms.size()) + 2; }
  Eigen::Index start_row() const { return size() - 2; }  ///< place of y(0); y'(0) follows
};

/// The force, ready for the integration at a fixed step.
class BenchInput {
 public:
  /// substeps: steps of Runge and Kutta's fourth order a sample.
  BenchInput(const Eigen::VectorXd& force_v, double sample_rate_hz, int substeps, Hold hold);
  Eigen::Index rows() const { return rows_; }
  double step_s() const { return step_s_; }
  int substeps() const { return substeps_; }
  /// 2 substeps values a sample.
  const Eigen::VectorXd& fine() const { return fine_; }
  /// Force at the end of the step that starts at a place of fine(): under a staircase, that before the jump.
  double end_of_step(Eigen::Index place) const { return fine_[place + (staircase_ ? 1 : 2)]; }

 private:
  Eigen::Index rows_;
  int substeps_;
  double step_s_;
  bool staircase_;
  Eigen::VectorXd fine_;
};

/// Steps a sample that keep the relative error of the phase, (w h)^4 / 120, below 1e-5 at the natural
/// frequency.
int substeps_for(double stiffness_per_s2, double sample_rate_hz);

/// Displacement at the samples, in free run: from the force and the first state alone, the state carried
/// through. Not finite from where the motion runs away.
Eigen::VectorXd simulate(const BenchInput& input, const BenchForm& form, const Eigen::VectorXd& parameters);

/// The same with its derivatives by all parameters (rows x parameters), from the variational equations
/// s'' = (da/dy) s + (da/dy') s' + da/dparameter, integrated beside the motion.
Eigen::VectorXd simulate(const BenchInput& input, const BenchForm& form, const Eigen::VectorXd& parameters,
                         Eigen::MatrixXd& jacobian);

}  // namespace hemi::diagnosis

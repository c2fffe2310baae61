// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>

#include "golden/diagnosis/effect_family.hpp"
#include "golden/diagnosis/row_space.hpp"

namespace hemi::diagnosis {

/// An effect in one of its forms.
struct Member {
  std::size_t family = 0;
  std::vector<double> shape;
  bool operator<(const Member& other) const {
    return family != other.family ? family < other.family : shape < other.shape;
  }
  bool operator==(const Member&) const = default;
};

/// The nominal model's parameters and a set of effects, fitted to one recording by generalised least squares.
struct HypothesisFit {
  double minus_two_log_likelihood = 0.0;  ///< with the noise that this hypothesis leaves
  Noise noise;
  Eigen::VectorXd coefficients;  ///< baseline steps, then each member's
  Eigen::MatrixXd covariance;
  std::vector<Eigen::Index> first;  ///< where each member's coefficients begin
  Reduced residual;                 ///< reduced rows
  double squares = 0.0;             ///< whitened residual's
};

/// Fits hypotheses about one recording around one simulation; keeps what it has computed.
class Hypotheses {
 public:
  Hypotheses(const Telemetry& telemetry, const RowSpace& space, Simulation simulation,
             std::vector<EffectFamily> families);
  /// Called before every computation of any length; may throw.
  void check_with(std::function<void()> check) { check_ = std::move(check); }

  const Simulation& simulation() const { return simulation_; }
  const RowSpace& space() const { return space_; }
  const std::vector<EffectFamily>& families() const { return families_; }
  const std::vector<BaselineColumn>& baseline() const { return baseline_; }
  const Reduced& baseline_rows() const { return baseline_rows_; }
  const Reduced& data() const { return data_; }
  const Noise& expected() const { return expected_; }

  /// Reduced columns of a member, computed once.
  const Reduced& columns(const Member& member);
  /// Columns of all: baseline, then each member's.
  Reduced design(const std::vector<Member>& members);
  /// Orthonormal basis of what a hypothesis does to one output.
  Eigen::MatrixXd noise_basis(Output output, const std::vector<Member>& members);
  /// Noise estimated from this hypothesis's own residual by restricted maximum likelihood.
  HypothesisFit fit(const std::vector<Member>& members);
  /// The same with noise that is given.
  HypothesisFit fit(const std::vector<Member>& members, const Noise& noise);
  /// Penalty for the nuisance columns' priors, a diagonal to add to the normal equations.
  Eigen::VectorXd prior_precision(Eigen::Index columns) const;

 private:
  const NoiseShape& own_noise(Output output, const std::vector<Member>& members);

  RowSpace space_;
  Simulation simulation_;
  std::vector<EffectFamily> families_;
  std::vector<BaselineColumn> baseline_;
  Reduced baseline_rows_, data_;
  Noise expected_;
  std::function<void()> check_ = [] {};
  std::map<Member, Reduced> columns_;
  std::map<std::pair<std::size_t, std::vector<Member>>, NoiseShape> noises_;
};

/// Orthonormal basis of the columns that are not zero.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

/// Columns beside each other.
Reduced joined(const std::vector<const Reduced*>& parts);

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
// The loops of force-to-rebalance as linear systems, solved exactly over one interval of telemetry.
#pragma once

#include <Eigen/Core>
#include <array>

#include "golden/physics/noise.hpp"

namespace hemi::physics {

/// Gains of a PI controller K (1 + z/s) around an integrator, its zero at a tenth of the crossover:
///
///     T(s) = K (s + z) / (s^2 + K s + K z),   |L(j wc)| = 1 at wc = K sqrt(1.01),   z = wc/10
///
/// and |T|^2 = 1/2 at w = K x, x^4 - (1 + 2 z/K) x^2 - (z/K)^2 = 0.
struct LoopGains {
  double k_per_s;
  double z_per_s;
  static LoopGains of_bandwidth(double closed_loop_3db_hz);
};

/// T(s) as the sum of its two modes, each with an input that is linear over the step.
class LoopResponse {
 public:
  LoopResponse(LoopGains gains, double dt_s);

  void settle(double input);
  /// One step with the input middle + slope (t - t_middle).
  void advance(double middle, double slope);
  double start() const { return start_; }  ///< output at the start of the step
  double mean() const { return mean_; }    ///< its average over the step
  double end() const { return end_; }

 private:
  struct Mode {
    double rate_per_s;
    double residue_per_s;
    double decay;
    double state;
  };
  double dt_s_;
  std::array<Mode, 2> modes_;
  double start_ = 0.0;
  double mean_ = 0.0;
  double end_ = 0.0;
};

/// Noise through one loop, white force F and white pickoff noise n, both with one-sided densities:
///
///     p' = F + D,   D = -K (p + n + z int (p + n) dt)
///
/// p: deflection that the loop holds at zero, D: its command. Averages over successive steps have exactly the
/// variances and covariances of the continuous system (matrix exponential, Lyapunov doubling).
class LoopNoise {
 public:
  LoopNoise(LoopGains gains, double dt_s, double force_density_per_s_rthz, double pickoff_density_rthz,
            std::uint64_t seed, std::uint64_t stream);

  void advance();
  double measured() const { return measured_; }            ///< mean of p + n
  double command_per_s() const { return command_per_s_; }  ///< mean of D

 private:
  static constexpr int kStates =
      5;  // p, int (p + n), int p, int n, int F; the last three from 0 in each step
  using Square = Eigen::Matrix<double, kStates, kStates>;
  using Vector = Eigen::Matrix<double, kStates, 1>;

  double dt_s_;
  Square transition_;
  Square kick_;  ///< its square is the covariance of what one step adds
  Vector state_ = Vector::Zero();
  double measured_ = 0.0;
  double command_per_s_ = 0.0;
  Gaussian gaussian_;
};

}  // namespace hemi::physics

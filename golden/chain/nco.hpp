// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "golden/chain/arithmetic.hpp"

namespace hemi::golden {

/// Sine of (angle + 1/2) 2^-24 turns times S / 2^20, S = config::table_scale: a line between two of the 512
/// values of a quarter wave that are rounded to 2^-20, the result rounded to config::sine. angle: whole
/// number in [0, 2^24).
double interpolated_sine(double angle);

/// Sine that the nco gives at a phase [turns]: interpolated_sine of its 24 bits behind the point when
/// quantised, S / 2^20 times the sine itself when ideal.
double nco_sine(const Arithmetic& arithmetic, double turns);

/// Numerically controlled oscillator: theta[n+1] = theta[n] + increment, gives (cos theta, sin theta) S /
/// 2^20.
///
/// Quantised: theta is floored to 2^-24 turn and taken at the middle of that step, so that the floor shifts
/// nothing on the average; see interpolated_sine. Ideal: cosine and sine of theta itself. The phase is kept
/// in [-16, 16) turns in both precisions, which resolves 2^-49 turns however long the run.
class Nco {
 public:
  /// increment: turns a sample, in [-1, 1).
  Nco(Precision precision, double increment) : arithmetic_(precision), increment_(increment) {}

  /// The next `count` samples. phase: turns modulo 32; cosine, sine: 1.
  void run(Eigen::Index count, Eigen::Ref<Eigen::ArrayXd> phase, Eigen::Ref<Eigen::ArrayXd> cosine,
           Eigen::Ref<Eigen::ArrayXd> sine);

  /// Phase of the sample to come, turns modulo 32.
  double phase() const { return phase_; }
  void set_increment(double increment) { increment_ = increment; }

 private:
  Arithmetic arithmetic_;
  double phase_ = 0.0;
  double increment_;
};

}  // namespace hemi::golden

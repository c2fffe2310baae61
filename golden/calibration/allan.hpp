// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "golden/calibration/rows.hpp"

namespace hemi::calibration {

enum class TauSpacing { kOctave, kDecade };

/// Which pairs of neighbouring averages enter: all, one a sample, or those that share no sample with another
/// of their kind, one an average. The second is the definition's own; the first knows the same value better.
enum class AllanEstimator { kOverlapping, kSeparate };

/// Allan deviation at one averaging time.
struct AllanPoint {
  double tau_s;
  Eigen::Index averaged;      ///< samples in one average
  Eigen::Index pairs;         ///< differences of neighbouring averages that entered
  double deviation;           ///< unit of the samples
  double degrees_of_freedom;  ///< equivalent ones, exact for white rate noise
  double lower;  ///< interval that holds the true value with 68.3 %, white rate noise taken for granted
  double upper;
};

/// White rate noise as read off the stretch of slope -1/2.
struct AngleRandomWalk {
  double coefficient;  ///< unit of the samples times square root of a second
  double from_s;       ///< stretch it was read from
  double to_s;
  /// deg/sqrt(h) for samples in deg/h.
  double deg_per_root_hour() const { return coefficient / 60.0; }
};

/// A noise term as read off the stretch of its slope.
struct NoiseReading {
  double coefficient;
  double from_s;  ///< stretch it was read from
  double to_s;
};

struct AllanResult {
  std::vector<AllanPoint> points;  ///< ascending tau
  std::optional<AngleRandomWalk> angle_random_walk;
  /// B of flicker noise, sigma = 0.664 B, unit of the samples: where the deviation is level.
  std::optional<NoiseReading> flicker;
  /// K of a random walk of the rate, sigma^2 = K^2 tau / 3, unit of the samples over root second.
  std::optional<NoiseReading> rate_random_walk;
  double bias_instability = 0.0;           ///< smallest deviation / 0.664, unit of the samples
  double bias_instability_tau_s = 0.0;     ///< where it lies
  bool bias_instability_is_bound = false;  ///< still falling at the longest tau: an upper bound
};

/// sigma^2(m tau0) = 1/2 mean over k of (mean of y[k+m..k+2m-1] - mean of y[k..k+m-1])^2, k = 0 .. N-2m, or
/// k = 0, m, 2m, ... (AllanEstimator::kSeparate).
///
/// rate: N >= 3 equally spaced finite samples, each an average over interval_s > 0; tau up to N/2 intervals,
/// at 1, 2, 4,
/// ... or 1, 10, 100, ... intervals. A noise term is given only where the slope of log sigma against
/// log tau, known to 0.1, stays within 0.1 of its own: -1/2 (angle random walk) and +1/2 (rate random walk)
/// over at least a decade of tau (three octaves and more; two decade points), 0 (flicker) over two octaves,
/// which the round minimum of white noise and a random walk alone does not reach: there it is 0.6 octaves.
/// Throws std::invalid_argument. Source: NIST SP 1065, sections 5.2.2 and 5.2.4; IEEE Std 952, annex C.
AllanResult allan_deviation(const Eigen::VectorXd& rate, double interval_s,
                            TauSpacing spacing = TauSpacing::kOctave,
                            AllanEstimator estimator = AllanEstimator::kOverlapping);

/// The same of samples with gaps: no difference reaches across the end of a stretch, the squares of all
/// stretches are averaged with one weight each, degrees of freedom are those of the weighted mean of
/// independent stretches. Samples outside the stretches do not enter, finite or not. A stretch of three
/// samples at least.
AllanResult allan_deviation(const Eigen::VectorXd& rate, const std::vector<RowRange>& stretches,
                            double interval_s, TauSpacing spacing = TauSpacing::kOctave,
                            AllanEstimator estimator = AllanEstimator::kOverlapping);

/// Bias stability in the paper's sense: standard deviation of the rate averaged over average_s at a time (an
/// unfinished last average is left out), unit of the samples. It counts trend and drift in full, unlike bias
/// instability. Needs two averages. Throws std::invalid_argument.
double bias_stability(const Eigen::VectorXd& rate, double interval_s, double average_s);

/// The same of samples with gaps: each stretch gives its whole averages.
double bias_stability(const Eigen::VectorXd& rate, const std::vector<RowRange>& stretches, double interval_s,
                      double average_s);

/// Equivalent degrees of freedom of the overlapping Allan variance of white rate noise: 2 mean^2 / variance
/// of the estimator, exactly, from the triangular correlation of its overlapping differences.
double white_degrees_of_freedom(Eigen::Index samples, Eigen::Index averaged);

}  // namespace hemi::calibration

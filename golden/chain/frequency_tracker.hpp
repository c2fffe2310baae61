// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "golden/chain/arithmetic.hpp"

namespace hemi::golden {

/// Weighted sum of the ticks of two output intervals, weights 1, 2, ..., 25, ..., 2, 1: what a double
/// integration at the tick rate followed by a double difference at the output rate comes to. Zeros before the
/// start.
class TriangularSum {
 public:
  void add(double value) { newer_[filled_++] = value; }
  /// Closes the output interval after its 25th tick.
  double close() {
    const double sum = (rising_ * older_ + (config::ticks_per_output - rising_) * newer_).sum();
    older_ = newer_;
    filled_ = 0;
    return sum;
  }

 private:
  using Ticks = Eigen::Array<double, config::ticks_per_output, 1>;
  Ticks rising_ = Ticks::LinSpaced(0.0, config::ticks_per_output - 1.0);
  Ticks older_ = Ticks::Zero();
  Ticks newer_ = Ticks::Zero();
  Eigen::Index filled_ = 0;
};

/// Frequency as the difference of the mean total phase of two neighbouring output intervals (Lambda
/// weighting).
///
/// The phase of tick k is that of the nco in the middle of tick k - 4, where the filters' delay puts the
/// centre of what the detector saw, plus the phase error. Only its steps from tick to tick are kept, weighted
/// by a triangle: with U their sum, sum over 25 ticks of (U[k] - U[k-25]) is that triangle, and no large
/// number appears in between. Exact in doubles when quantised: 625 steps of at most 2^36 units are below
/// 2^46. Equal to the accumulation modulo 2^46 units because every sum is a sum of whole numbers and wrapping
/// commutes with it.
class FrequencyTracker {
 public:
  explicit FrequencyTracker(Precision precision) : arithmetic_(precision) {}

  /// nco_phase: turns, after the tick's samples; phase_error: turns. Returns the tick's phase, turns
  /// modulo 32.
  double tick(double nco_phase, double phase_error) {
    const double turned = modulo(nco_phase - last_nco_phase_, kPhaseSpan);
    last_nco_phase_ = nco_phase;
    const double middle =
        modulo(nco_phase - arithmetic_.floor(turned / 2, config::phase.fraction), kPhaseSpan);
    const double delayed = middles_[kDelay - 1];
    middles_.tail<kDelay - 1>() = middles_.head<kDelay - 1>().eval();
    middles_[0] = arithmetic_.floor(middle, config::tick_phase.fraction);
    const double phase = modulo(delayed + phase_error, kPhaseSpan);
    steps_.add(modulo(phase - last_phase_, kPhaseSpan));
    last_phase_ = phase;
    return phase;
  }

  /// Nominal Hz, modulo 2^17: phases in turns over intervals of 1/200 s, summed over 25 ticks.
  double output() {
    constexpr double kHzPerTurn = static_cast<double>(config::output_rate_hz) / config::ticks_per_output;
    return modulo(steps_.close() * kHzPerTurn, span_of(config::frequency));
  }

 private:
  static constexpr double kPhaseSpan = 32.0;  // turns
  static constexpr int kDelay = 4;            // ticks

  Arithmetic arithmetic_;
  double last_nco_phase_ = 0.0;
  double last_phase_ = 0.0;
  Eigen::Array<double, kDelay, 1> middles_ = Eigen::Array<double, kDelay, 1>::Zero();
  TriangularSum steps_;
};

/// In-phase secondary or rebalance command times a gain, weighted over two output intervals by a triangle of
/// sum 625. The sum stays below 625 * 1024, inside the 47 bits that it is accumulated in modulo 2^21: no wrap
/// shows.
class RateFilter {
 public:
  RateFilter(Precision precision, double gain) : arithmetic_(precision), gain_(gain) {}

  /// Returns deg/h / 625.
  double tick(double source, bool& clipped) {
    // A command of 32 bits times a gain of 24 can need 54: hence the product that is rounded as a whole.
    const double rate = arithmetic_.saturate(
        arithmetic_.round_product(source, gain_, config::rate_tick.fraction), config::rate_tick, clipped);
    ticks_.add(rate);
    return rate;
  }
  /// deg/h.
  double output(bool& clipped) {
    return arithmetic_.saturate(arithmetic_.round(ticks_.close(), config::rate.fraction), config::rate,
                                clipped);
  }

 private:
  Arithmetic arithmetic_;
  double gain_;
  TriangularSum ticks_;
};

}  // namespace hemi::golden

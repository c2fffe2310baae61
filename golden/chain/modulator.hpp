// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "golden/chain/nco.hpp"

namespace hemi::golden {

/// Commands of the three actuators, fractions of their full scales.
struct Commands {
  double drive = 0.0;
  double quadrature = 0.0;
  double rebalance = 0.0;
};

/// What the three DACs get with one sample, fractions of full scale; multiples of 2^-15 when quantised.
struct DacWords {
  double drive = 0.0;
  double rebalance = 0.0;
  double quadrature = 0.0;
};

/// Rounding to the words of a DAC with the error fed back: word(z) = value(z) - (1 - z^-1) error(z), |error|
/// at most half a word. The sum of the words stays within half a word of the sum of the values as long as
/// none is clipped; what a clipped word misses is given up. Ideal: the value itself within the DAC's range.
class ErrorFeedback {
 public:
  explicit ErrorFeedback(Precision precision) : arithmetic_(precision) {}
  double operator()(double value);

 private:
  Arithmetic arithmetic_;
  double error_ = 0.0;
};

/// Commands to DAC words: drive and rebalance force on the carrier -sin(theta + offset), the phase of the
/// velocity of cos theta; quadrature force is constant. offset = phase + delay * increment leads by what
/// converters and electronics take. The commands of a tick and their offset come into force a tick later.
class Modulator {
 public:
  struct Settings {
    double phase;  ///< turns
    double delay;  ///< samples
  };

  Modulator(Precision precision, const Settings& settings);

  /// What the last tick computed comes into force.
  void engage() { now_ = next_; }
  /// increment: turns a sample, of the nco while these commands will be in force.
  void tick(const Commands& commands, double increment);
  /// phase: of the nco, turns modulo 32, one a sample; carrier: S / 2^20 sin(theta + offset); drive,
  /// rebalance: DAC words.
  void run(const Eigen::Ref<const Eigen::ArrayXd>& phase, Eigen::Ref<Eigen::ArrayXd> carrier,
           Eigen::Ref<Eigen::ArrayXd> drive, Eigen::Ref<Eigen::ArrayXd> rebalance);

  double quadrature() const { return now_.quadrature; }        ///< DAC word in force
  double next_quadrature() const { return next_.quadrature; }  ///< DAC word of the last tick
  double next_offset() const { return next_.offset; }          ///< turns in [-1/2, 1/2), of the last tick

 private:
  struct Held {
    double drive = 0.0;
    double rebalance = 0.0;
    double offset = 0.0;
    double quadrature = 0.0;
  };

  Arithmetic arithmetic_;
  Settings settings_;
  Held now_;
  Held next_;
  ErrorFeedback drive_dac_;
  ErrorFeedback rebalance_dac_;
  ErrorFeedback quadrature_dac_;
};

}  // namespace hemi::golden

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "golden/concealed/world.hpp"

namespace hemi::concealed {

/// A difference of outputs, one series a channel, all as long as the run.
using Trace = std::array<Series, kOutputs>;

/// What the nominal simulation misses in `with`: its outputs less those of `without`, and less what a false
/// reading of the case thermometer makes the nominal simulation add by itself.
Trace trace_of(const State& with, const State& without, const Model& model, const Excitation& in,
               double start_offset_degc);

/// What a thermometer error [degC] does to the nominal simulation's outputs.
Trace thermometer_trace(const Series& error_degc, const State& without, const Model& model,
                        const Excitation& in, double start_offset_degc);

/// d': norm of an effect's trace over the noise once the nominal model's own numbers (polynomial, time
/// constant, start, lag below a sample, all ten bias terms, scale factor, both commands) have been refitted
/// to it, to first order. The noise is each channel's own plus what the case thermometer's errors make of it;
/// blocks of 20 s are whitened exactly (Levinson-Durbin on the Toeplitz covariance of their means), what
/// varies within a block by its spectrum.
class Detectability {
 public:
  /// `thermometer`: the outputs' errors due to this run's rounded and noisy case thermometer; their smoothed
  /// periodogram counts as noise.
  Detectability(const Model& model, const Excitation& in, double start_offset_degc,
                const std::array<NoiseLevel, kOutputs>& noise, const Trace& thermometer);

  struct Share {
    double dprime = 0.0;
    std::array<double, kOutputs> channel{};             ///< energy, sums to dprime^2
    std::array<std::vector<double>, kOutputs> block{};  ///< slow part's energy, one value a 20 s block
  };
  /// After the refit.
  Share share(const Trace& trace) const;
  double dprime(const Trace& trace) const;
  /// d' of what `other` at any strength cannot take over as well.
  double dprime_beside(const Trace& trace, const Trace& other) const;
  /// Without any refit.
  double raw(const Trace& trace) const;

 private:
  Eigen::VectorXd white(const Trace& trace) const;
  Eigen::VectorXd projected(const Trace& trace) const;
  void add_nuisance(const Trace& trace);

  Eigen::Index samples_ = 0, blocks_ = 0;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> cuts_{};  ///< rows that are not recorded
  std::array<Eigen::VectorXd, kOutputs> block_covariance_{};
  std::array<Series, kOutputs> fast_scale_{};  ///< 1 / root of the variance of a normalised Fourier line
  std::vector<Eigen::VectorXd> basis_{};
};

}  // namespace hemi::concealed

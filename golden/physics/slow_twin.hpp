// SPDX-License-Identifier: Apache-2.0
// The instrument in force-to-rebalance mode at the rate of its telemetry: averaged equations instead of
// vibrations.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "golden/physics/world.hpp"

namespace hemi::physics {

/// Closed-loop bandwidths (-3 dB) of the three loops that telemetry can see. The frequency is counted from
/// the total phase, so that the reference-phase loop does not show in it.
struct LoopBandwidths {
  double rebalance_hz = 40.0;
  double quadrature_hz = 1.0;
  double amplitude_hz = 0.5;
};

struct SlowTwinOptions {
  bool noise =
      true;  ///< the instrument's noise and the thermometer's steps; effects that are noise act anyway
  std::uint64_t seed = 0;  ///< same seed, same telemetry
  LoopBandwidths loops{};
};

/// Telemetry of an instrument along inputs at its sample times, which are the centres of the intervals that a
/// sample averages over. Equations in docs/effects.md.
///
/// inputs: equally spaced in time (spacing of at least one output interval of the core, 5 ms); held over each
/// interval, that is, steps fall between samples, except that rate_dph varies by rate_slope_dph_s within the
/// interval and that the chamber is linear from sample to sample. The first sample is settled. Throws
/// std::invalid_argument for unequal spacing, effects that the catalogue does not have, values out of range,
/// and an amplitude that a clipping front end cannot reach.
std::vector<TelemetrySample> simulate_slow(const Instrument& instrument,
                                           const std::vector<ActiveEffect>& effects,
                                           const std::vector<Environment>& inputs,
                                           const SlowTwinOptions& options = {});

/// `count` inputs at start_s, start_s + interval_s, ...; the time is set here.
std::vector<Environment> sample_inputs(const std::function<Environment(double time_s)>& profile,
                                       double start_s, double interval_s, std::size_t count);

}  // namespace hemi::physics

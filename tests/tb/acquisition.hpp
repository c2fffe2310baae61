// SPDX-License-Identifier: Apache-2.0
// Random starts: the resonator rings somehow, all loops must come to rest within ten seconds.
#ifndef HEMI_TESTS_TB_ACQUISITION_HPP
#define HEMI_TESTS_TB_ACQUISITION_HPP

#include <gtest/gtest.h>

#include <string>

#include "tb/hls_engine.hpp"
#include "tests/tb/control_bench.hpp"

namespace hemi::tests {

/// All loops at work and settled: amplitude within 0.1 % (which is 0.1 % of the scale factor), what is left
/// of the second mode below 1e-4 of the amplitude (0.1 mHz of split), phase within a thousandth of a turn.
inline std::string unsettled(const Reading& r, const physics::Motion& motion, double omega_rad_s) {
  if (r.live != 0) return "status " + std::to_string(r.live);
  if (std::abs(r.amplitude - 1.0) > 1e-3) return "amplitude " + std::to_string(r.amplitude);
  if (std::abs(r.phase_error_turns) > 1e-3) return "phase " + std::to_string(r.phase_error_turns);
  const double second = std::hypot(motion.y, motion.y_rate_per_s / omega_rad_s);
  if (second > 1e-4) return "second mode " + std::to_string(second);
  return {};
}

struct Start {
  double offset_hz;
  physics::InitialVibration vibration;
};

inline Start random_start(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  // At least a tenth of the nominal amplitude in the primary; the second mode anything up to that.
  const double amplitude = std::pow(10.0, -unit(generator));
  return {120.0 * unit(generator) - 60.0,
          {amplitude, 2 * std::numbers::pi * unit(generator), 0.1 * unit(generator),
           2 * std::numbers::pi * unit(generator)}};
}

inline void acquire(int starts, unsigned seed) {
  std::mt19937_64 generator(seed);
  int failed = 0;
  for (int i = 0; i < starts; ++i) {
    const Start start = random_start(generator);
    physics::Instrument instrument;
    const double nominal_rad_s = instrument.at(20.0).omega_rad_s;
    physics::Parameters p = instrument.at(20.0);
    p.omega_rad_s = nominal_rad_s + 2 * std::numbers::pi * start.offset_hz;
    auto source = [p](double, double) { return p; };
    ControlBench bench(tb::make_hls_engine(false), instrument, false, start.vibration,
                       static_cast<std::uint64_t>(i) + 1, source);
    bench.run(9.9);
    const auto readings = bench.run(0.1);
    // The mean of the last twenty readings: a single one carries the noise of 5 ms.
    Reading mean = readings.back();
    mean.amplitude = mean.phase_error_turns = 0.0;
    for (const auto& r : readings) {
      mean.live |= r.live;
      mean.amplitude += r.amplitude / static_cast<double>(readings.size());
      mean.phase_error_turns += r.phase_error_turns / static_cast<double>(readings.size());
    }
    const std::string why = unsettled(mean, bench.plant().motion(), p.omega_rad_s);
    if (!why.empty()) {
      ++failed;
      ADD_FAILURE() << "start " << i << ": " << start.offset_hz << " Hz, amplitude "
                    << start.vibration.x_amplitude << ": " << why;
    }
  }
  std::printf("%d of %d starts failed\n", failed, starts);
}

}  // namespace hemi::tests

#endif  // HEMI_TESTS_TB_ACQUISITION_HPP

// SPDX-License-Identifier: Apache-2.0
// The nominal instrument in force-to-rebalance mode around an engine, for tests.
#ifndef HEMI_TESTS_TB_CONTROL_BENCH_HPP
#define HEMI_TESTS_TB_CONTROL_BENCH_HPP

#include <memory>
#include <vector>

#include "golden/loops/control.hpp"
#include "tb/closed_loop.hpp"
#include "tb/engine.hpp"
#include "tests/tb/signals.hpp"

namespace hemi::tests {

inline loops::CoreSampling sampling(bool wide) {
  return wide ? loops::CoreSampling::wide() : loops::CoreSampling::reference();
}

/// Registers of the whole core for `instrument`: loops by design, the rest busy.
inline tb::RegisterValues control_registers(const physics::Instrument& instrument, bool wide,
                                            const loops::ControlWishes& wishes = {}) {
  tb::RegisterValues values = busy_registers(wide, 4425.0);
  values[config::reg_calibrated_low] = -1.0;
  values[config::reg_calibrated_high] = 0.999;
  loops::set_control(values, instrument, sampling(wide), wishes);
  return values;
}

/// A record in units; amplitude in nominal amplitudes, commands as fractions of full scale, means over their
/// interval.
struct Reading {
  double frequency_hz;
  double amplitude;
  double phase_error_turns;
  double drive;
  double quadrature;
  double rate_dph;
  std::uint64_t live;  ///< status bits
};

inline Reading reading(const tb::Record& record, double amplitude_word) {
  constexpr double ticks = 2.0 * config::ticks_per_output;
  const auto& w = record.words;
  const auto status = static_cast<std::uint64_t>(w[config::word_status]);
  return {w[config::word_frequency],
          w[config::word_amplitude] / ticks / amplitude_word,
          w[config::word_phase_error] / ticks,
          w[config::word_drive] / ticks,
          w[config::word_quadrature] / ticks,
          w[config::word_rate],
          status & ((std::uint64_t{1} << config::status_shift) - 1)};
}

inline bool raised(const Reading& r, config::StatusBit bit) {
  return (r.live >> bit & 1) != 0;
}

/// At 20 degC on a table whose rate [deg/s] may be changed between runs.
inline physics::ParameterSource turning(const physics::Instrument& instrument, const double& rate_dps) {
  return [at20 = instrument.at(20.0), &rate_dps](double, double) {
    physics::Parameters p = at20;
    p.rate_rad_s = rate_dps * std::numbers::pi / 180.0;
    return p;
  };
}

/// Plant and engine together; the plant's parameters come from `source` (constant: Instrument::at(20)).
class ControlBench {
 public:
  ControlBench(std::unique_ptr<tb::Engine> engine, const physics::Instrument& instrument, bool wide,
               const physics::InitialVibration& start, std::uint64_t seed,
               physics::ParameterSource source = {}, const loops::ControlWishes& wishes = {})
      : engine_(std::move(engine)),
        design_(loops::design_control(instrument, sampling(wide), wishes)),
        sampling_(sampling(wide)) {
    physics::PlantConfiguration configuration;
    configuration.adc = wide ? physics::AdcConfiguration::wide() : physics::AdcConfiguration::reference();
    configuration.start = start;
    configuration.seed = seed;
    if (!source) source = [p = instrument.at(20.0)](double, double) { return p; };
    plant_ = std::make_unique<physics::Plant>(instrument, std::move(source), configuration);
    engine_->reset(control_registers(instrument, wide, wishes));
  }

  /// Runs on; the readings of the records that came.
  template <class OnSample = tb::Untouched, class OnWords = tb::Untouched>
  std::vector<Reading> run(double seconds, OnSample&& on_sample = {}, OnWords&& on_words = {}) {
    std::vector<tb::Record> records;
    tb::close_loop(*engine_, *plant_, static_cast<std::size_t>(seconds * sampling_.adc_rate_hz + 0.5),
                   records, on_sample, on_words);
    std::vector<Reading> readings;
    for (const auto& record : records) readings.push_back(reading(record, design_.amplitude_word));
    return readings;
  }

  physics::Plant& plant() { return *plant_; }
  tb::Engine& engine() { return *engine_; }
  const loops::ControlDesign& design() const { return design_; }

 private:
  std::unique_ptr<tb::Engine> engine_;
  loops::ControlDesign design_;
  loops::CoreSampling sampling_;
  std::unique_ptr<physics::Plant> plant_;
};

}  // namespace hemi::tests

#endif  // HEMI_TESTS_TB_CONTROL_BENCH_HPP

// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cli/scenario/control.hpp"
#include "golden/calibration/frequency_polynomial.hpp"
#include "hls/config.hpp"

namespace hemi::scenario {
namespace {

/// The key that says a thing, or its whole section.
Where where_of(const Section& section, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    if (section.has(key)) return section.where(key);
  }
  return section.where();
}

Where where_of_input(const Section& file, std::string_view name) {
  return where_of(file.section(name), {"profile", "steps", "levels", "sine", "soaks", "cycles",
                                       "temperature_degc", "rate_dph", "setpoint", "trim_v"});
}

/// Parameters at temperatures that cover the chamber's range, ends included.
std::vector<physics::Parameters> over_range(const Scenario& scenario, double low_degc, double high_degc) {
  constexpr int kSteps = 100;
  std::vector<physics::Parameters> all;
  for (int i = 0; i <= kSteps; ++i)
    all.push_back(scenario.instrument.at(low_degc + (high_degc - low_degc) * i / kSteps));
  return all;
}

void check_frequency(const Scenario& scenario, const Section& file) {
  const TemperatureRange range = scenario.temperatures();
  const auto& coefficients = scenario.instrument.frequency_hz;
  const Where polynomial = where_of(file.section("instrument"), {"frequency_hz", "model"});
  if (coefficients.size() < 2) {
    refuse(polynomial, "f(T) does not depend on the temperature", "give at least two coefficients");
  }
  const Eigen::Map<const Eigen::VectorXd> c(coefficients.data(),
                                            static_cast<Eigen::Index>(coefficients.size()));
  const calibration::FrequencyPolynomial f(c, scenario.instrument.frequency_reference_degc, range.low_degc,
                                           range.high_degc);
  const double ends_hz[] = {f.frequency_hz(range.low_degc), f.frequency_hz(range.high_degc)};
  if (!f.monotone()) {
    refuse(where_of_input(file, "chamber"),
           fmt::format("f(T) is not monotonic from {:g} to {:g} degC, the chamber's range and 5 degC more",
                       range.low_degc, range.high_degc),
           "stay inside the monotonic range, or correct instrument.frequency_hz");
  }
  if (!(std::min(ends_hz[0], ends_hz[1]) > 0.0 && std::isfinite(ends_hz[0] + ends_hz[1]))) {
    refuse(polynomial,
           fmt::format("f(T) runs from {:g} to {:g} Hz over the chamber's range", ends_hz[0], ends_hz[1]),
           "a resonator's frequency is above zero");
  }
  if (scenario.mode == Mode::slow) return;
  const double adc_hz = scenario.wide ? config::Wide::adc_rate_hz : config::Reference::adc_rate_hz;
  for (const double hz : ends_hz) {
    if (hz >= 0.005 * adc_hz && hz <= 0.26 * adc_hz) continue;
    refuse(polynomial,
           fmt::format("{:g} Hz is {:.4g} of the ADC's rate; the core takes 0.005 to 0.26", hz, hz / adc_hz),
           "correct f(T), or choose another adc in [scenario]");
  }
}

void check_actuators(const Scenario& scenario, const Section& file) {
  const auto [low_degc, high_degc] = scenario.inputs.chamber_degc.range(scenario.duration_s);
  const double amplitude = scenario.inputs.setpoint.range(scenario.duration_s).second;
  const auto [trim_low, trim_high] = scenario.inputs.trim_v.range(scenario.duration_s);
  const double trim =
      std::max(std::abs(trim_low), std::abs(trim_high)) / scenario.instrument.quadrature_full_scale_v;
  const Section instrument = file.section("instrument");
  for (const physics::Parameters& p : over_range(scenario, low_degc, high_degc)) {
    if (!(p.damping_per_s > 0.0)) {
      refuse(where_of(instrument, {"relative_damping", "model"}),
             "the damping is not above zero over the chamber's range", "correct the polynomial");
    }
    const double drive = amplitude * (p.damping_per_s + 0.5 * p.mismatch_cos_per_s) / p.drive_per_s;
    if (drive > 1.0) {
      refuse(where_of(instrument, {"drive_full_scale_over_steady", "relative_damping", "model"}),
             fmt::format("holding amplitude {:g} needs {:.3g} % of the drive's full scale", amplitude,
                         100.0 * drive),
             "lower amplitude.setpoint or the damping, or raise drive_full_scale_over_steady");
    }
    const double split = std::abs(p.split_sin_rad_s / p.quadrature_span_rad_s);
    const double quadrature = split + trim;
    if (quadrature > 1.0) {
      refuse(split <= 1.0
                 ? where_of_input(file, "quadrature")
                 : where_of(instrument, {"split_hz", "quadrature_full_scale_hz", "relative_split", "model"}),
             fmt::format("split and trim need {:.3g} % of the quadrature electrode's full scale",
                         100.0 * quadrature),
             "lower split_hz or quadrature.trim_v, or raise quadrature_full_scale_hz");
    }
  }
}

void check_inputs(const Scenario& scenario, const Section& file) {
  const physics::Instrument& instrument = scenario.instrument;
  const double amplitude = scenario.inputs.setpoint.range(scenario.duration_s).second;
  if (amplitude * instrument.pickoff_full_scale_per_amplitude > 1.0) {
    refuse(where_of_input(file, "amplitude"),
           fmt::format("amplitude {:g} is {:.3g} % of the ADC's full scale", amplitude,
                       100.0 * amplitude * instrument.pickoff_full_scale_per_amplitude),
           "lower the set point or instrument.pickoff_full_scale_per_amplitude");
  }
  const auto [low_dph, high_dph] = scenario.inputs.rate_dph.range(scenario.duration_s);
  const double fastest_dps =
      std::abs(scenario.inputs.scale_factor) * std::max(std::abs(low_dph), std::abs(high_dph)) / 3600.0;
  if (fastest_dps > instrument.rebalance_full_scale_dps) {
    refuse(where_of_input(file, "table"),
           fmt::format("{:g} deg/s is more than the rebalance loop's full scale, {:g} deg/s", fastest_dps,
                       instrument.rebalance_full_scale_dps),
           "turn more slowly, or raise instrument.rebalance_full_scale_dps");
  }
}

/// In mode full the core's registers hold bandwidths and set point, and its quadrature loop takes every trim
/// back.
void check_core(const Scenario& scenario, const Section& file) {
  if (!scenario.inputs.setpoint.constant()) {
    refuse(where_of_input(file, "amplitude"),
           "changes during the run, and the core's set point is a register",
           "give a constant setpoint, or use mode = \"slow\"");
  }
  const auto [trim_low, trim_high] = scenario.inputs.trim_v.range(scenario.duration_s);
  if (trim_low != 0.0 || trim_high != 0.0) {
    refuse(where_of_input(file, "quadrature"), "the core has no input for a trim", "use mode = \"slow\"");
  }
  struct Bandwidth {
    std::string_view key;
    double loops::ControlWishes::*member;
  };
  const Section section = file.section("loops");
  const loops::ControlWishes wanted = control_wishes(scenario);
  for (const Bandwidth& bandwidth :
       {Bandwidth{"reference_phase_hz", &loops::ControlWishes::reference_phase_hz},
        Bandwidth{"rebalance_hz", &loops::ControlWishes::rebalance_hz},
        Bandwidth{"quadrature_hz", &loops::ControlWishes::quadrature_hz},
        Bandwidth{"amplitude_hz", &loops::ControlWishes::amplitude_hz}}) {
    loops::ControlWishes wishes;
    wishes.amplitude_setpoint = wanted.amplitude_setpoint;
    wishes.*bandwidth.member = wanted.*bandwidth.member;
    try {
      loops::design_control(scenario.instrument, core_sampling(scenario), wishes);
    } catch (const std::invalid_argument& error) {
      section.refuse(bandwidth.key, error.what(), "lower the bandwidth");
    }
  }
}

}  // namespace

void check_physics(const Scenario& scenario, const Section& file) {
  check_frequency(scenario, file);
  check_actuators(scenario, file);
  check_inputs(scenario, file);
  if (scenario.mode == Mode::full) check_core(scenario, file);
}

}  // namespace hemi::scenario

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/slow_twin.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "golden/physics/slow_twin_loops.hpp"
#include "golden/physics/slow_twin_noise.hpp"
#include "golden/physics/slow_twin_pickoff.hpp"

namespace hemi::physics {

namespace {

/// Averages over one interval of the true amplitude and its powers.
struct Amplitude {
  double slope_per_s;
  double mean;
  double square;
  double cube;
};

double interval_of(const std::vector<Environment>& inputs) {
  if (inputs.size() < 2) return 1.0;
  const double dt_s = (inputs.back().time_s - inputs.front().time_s) / static_cast<double>(inputs.size() - 1);
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    const double step_s = inputs[i].time_s - inputs[i - 1].time_s;
    if (!(std::abs(step_s - dt_s) < 1e-6 * dt_s)) {
      throw std::invalid_argument(fmt::format(
          "inputs of the slow twin must be equally spaced: {} s between samples {} and {}, {} s on average",
          step_s, i - 1, i, dt_s));
    }
  }
  return dt_s;
}

/// Decay rate of the amplitude, nonlinear parts included, without the drive.
double loss_per_s(const Parameters& p, const Amplitude& a) {
  return p.damping_per_s + 0.5 * p.mismatch_cos_per_s +
         (p.damping_per_s * p.quadratic_damping * a.square + p.cubic_damping_per_s * a.cube) / a.mean;
}

class SlowTwin {
 public:
  SlowTwin(const Instrument& instrument, const std::vector<ActiveEffect>& effects, const Environment& start,
           const SlowTwinOptions& options, double dt_s)
      : world_(instrument, effects, start, options.seed),
        dt_s_(dt_s),
        pickoff_(instrument),
        amplitude_loop_(LoopGains::of_bandwidth(options.loops.amplitude_hz), dt_s),
        loss_loop_(LoopGains::of_bandwidth(options.loops.amplitude_hz), dt_s),
        quadrature_loop_(LoopGains::of_bandwidth(options.loops.quadrature_hz), dt_s),
        rebalance_loop_(LoopGains::of_bandwidth(options.loops.rebalance_hz), dt_s) {
    amplitude_loop_.settle(start.amplitude_setpoint);
    end_amplitude_ = pickoff_.amplitude(start.amplitude_setpoint, world_.parameters());
    const Parameters& p = world_.parameters();
    const double square = end_amplitude_ * end_amplitude_;
    loss_loop_.settle(loss_per_s(p, {0.0, end_amplitude_, square, square * end_amplitude_}));
    quadrature_loop_.settle(split_to_cancel(world_.parameters()));
    rebalance_loop_.settle(rate_demand(world_.parameters(), end_amplitude_, 0.0));
    if (options.noise) noise_.emplace(world_.instrument(), options, dt_s);
  }

  World& world() { return world_; }
  TelemetrySample step(const Environment& input);

 private:
  /// The split that the quadrature command has to cancel; an angular acceleration acts like one.
  static double split_to_cancel(const Parameters& p) {
    return p.split_sin_rad_s - p.kappa * p.rate_slope_rad_s2 / p.omega_rad_s;
  }
  /// Growth of the secondary that the rebalance force has to undo [1/s]; what is left of the split leaks in
  /// through the phase of the demodulation.
  static double rate_demand(const Parameters& p, double amplitude, double residual_split_rad_s) {
    const double leak =
        p.pickoff_phase_y_rad == 0.0 ? 0.0 : std::tan(p.pickoff_phase_y_rad) * residual_split_rad_s;
    return (p.kappa * p.rate_rad_s + 0.5 * (p.mismatch_sin_per_s - leak)) * amplitude;
  }
  Amplitude vibrate(double setpoint);
  double frequency(const Parameters& p, const Amplitude& a, double lead) const;

  World world_;
  double dt_s_;
  PickoffCurve pickoff_;
  LoopResponse amplitude_loop_;
  LoopResponse loss_loop_;
  LoopResponse quadrature_loop_;
  LoopResponse rebalance_loop_;
  double end_amplitude_ = 1.0;
  std::optional<SlowTwinNoise> noise_;
};

Amplitude SlowTwin::vibrate(double setpoint) {
  amplitude_loop_.advance(setpoint, 0.0);
  const Parameters& p = world_.parameters();
  const double start = end_amplitude_;
  end_amplitude_ = pickoff_.amplitude(amplitude_loop_.end(), p);
  const double mean = pickoff_.amplitude(amplitude_loop_.mean(), p);
  // The parabola through both ends with this mean, and Simpson's rule for its powers.
  const double middle = 0.25 * (6.0 * mean - start - end_amplitude_);
  const auto average = [&](auto power) {
    return (power(start) + 4.0 * power(middle) + power(end_amplitude_)) / 6.0;
  };
  return {(end_amplitude_ - start) / dt_s_, mean, average([](double a) { return a * a; }),
          average([](double a) { return a * a * a; })};
}

double SlowTwin::frequency(const Parameters& p, const Amplitude& a, double lead) const {
  const double w = p.omega_rad_s;
  const double turning = p.rate_rad_s / w;
  const double centred = w * std::sqrt(1.0 - p.centrifugal * turning * turning);
  const double k2 = p.quadratic_stiffness;
  const double pulled = w * (0.375 * p.cubic_stiffness - 5.0 / 12.0 * k2 * k2) * a.square;
  const double reference = centred - 0.5 * p.split_cos_rad_s + pulled + lead * p.damping_per_s;
  return reference / kTwoPi * (1.0 - p.oscillator_error);
}

TelemetrySample SlowTwin::step(const Environment& input) {
  world_.advance(input, end_amplitude_);
  const Parameters& p = world_.parameters();
  const Instrument& instrument = world_.instrument();

  const Amplitude a = vibrate(input.amplitude_setpoint);
  const double measured = amplitude_loop_.mean();
  // A spring that softens while it swings lets the amplitude grow as w^-1/2, the action being constant.
  const Conditions& now = world_.conditions();
  const double softening_per_s = 0.5 * now.frequency_slope_hz_s / now.frequency_hz;
  // Losses that change reach the drive through the amplitude loop.
  loss_loop_.advance(loss_per_s(p, a) + softening_per_s, 0.0);
  double drive = (a.slope_per_s + loss_loop_.mean() * a.mean) / p.drive_per_s;
  // Feedthrough stands 90 degrees from the vibration: the reference lags by atan(lead), and the drive pushes
  // beside it.
  double lead = 0.0;
  if (p.drive_feedthrough != 0.0) {
    lead = p.drive_feedthrough * drive / (instrument.pickoff_full_scale_per_amplitude * measured);
    drive *= 1.0 + lead * lead;
  }

  const double split = split_to_cancel(p);
  quadrature_loop_.advance(split, 0.0);
  const double volts_per_split = instrument.quadrature_full_scale_v / p.quadrature_span_rad_s;
  const double cancelled = quadrature_loop_.mean() + input.quadrature_trim_v / (volts_per_split * measured);

  const double demand = rate_demand(p, a.mean, split - cancelled);
  rebalance_loop_.advance(demand, p.kappa * p.rate_slope_rad_s2 * a.mean);
  const double rebalance =
      (rebalance_loop_.mean() - p.forcer_misalignment_rad * p.drive_per_s * drive) / p.rebalance_per_s;

  TelemetrySample sample;
  sample.time_s = input.time_s;
  sample.case_temp_degc = now.temperatures.case_degc;
  sample.board_temp_degc = now.temperatures.board_degc;
  sample.rate_in_dph = input.rate_dph;
  sample.accel_g = input.accel_g;
  sample.supply_v = input.supply_v;
  sample.quadrature_trim_v = input.quadrature_trim_v;
  sample.frequency_hz = frequency(p, a, lead);
  sample.amplitude = measured;
  sample.drive_v = drive * instrument.drive_full_scale_v;
  sample.quadrature_v = cancelled * volts_per_split * measured;
  sample.rate_dph = rebalance * instrument.rebalance_full_scale_dps * 3600.0;
  if (noise_) noise_->add(p, a.mean, sample);
  return sample;
}

}  // namespace

std::vector<TelemetrySample> simulate_slow(const Instrument& instrument,
                                           const std::vector<ActiveEffect>& effects,
                                           const std::vector<Environment>& inputs,
                                           const SlowTwinOptions& options) {
  std::vector<TelemetrySample> telemetry;
  if (inputs.empty()) return telemetry;
  SlowTwin twin(instrument, effects, inputs.front(), options, interval_of(inputs));
  telemetry.reserve(inputs.size());
  for (const Environment& input : inputs) telemetry.push_back(twin.step(input));
  twin.world().distort(telemetry);
  return telemetry;
}

std::vector<Environment> sample_inputs(const std::function<Environment(double time_s)>& profile,
                                       double start_s, double interval_s, std::size_t count) {
  std::vector<Environment> inputs;
  inputs.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = start_s + interval_s * static_cast<double>(i);
    inputs.push_back(profile(time_s));
    inputs.back().time_s = time_s;
  }
  return inputs;
}

}  // namespace hemi::physics

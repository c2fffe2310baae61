// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/slow_twin_noise.hpp"

#include <cmath>
#include <numbers>

#include "golden/physics/noise.hpp"
#include "hls/config.hpp"

namespace hemi::physics {

namespace {

constexpr double kOutputInterval_s = 1.0 / config::output_rate_hz;

enum NoiseStream : std::uint64_t { kRebalance = 101, kQuadrature, kAmplitude, kFlicker, kOther };

/// sqrt(S_n)
double pickoff_density(const Instrument& instrument) {
  const double lsb = std::sqrt(instrument.pickoff_noise_lsb * instrument.pickoff_noise_lsb + 1.0 / 12.0);
  const double full_scale_lsb = std::ldexp(1.0, config::Reference::adc_bits - 1);
  const double amplitude = lsb / (full_scale_lsb * instrument.pickoff_full_scale_per_amplitude);
  return 2.0 * amplitude / std::sqrt(static_cast<double>(config::Reference::adc_rate_hz));
}

/// sqrt(S_F)
double force_density(const Instrument& instrument) {
  return instrument.kappa * instrument.force_noise_dph_rthz * kRadPerSecondPerDph;
}

LoopNoise loop(const Instrument& instrument, double bandwidth_hz, double dt_s, std::uint64_t seed,
               std::uint64_t stream) {
  return {LoopGains::of_bandwidth(bandwidth_hz), dt_s, force_density(instrument),
          pickoff_density(instrument),           seed, stream};
}

}  // namespace

SlowTwinNoise::SlowTwinNoise(const Instrument& instrument, const SlowTwinOptions& options, double dt_s)
    : instrument_(instrument),
      dt_s_(dt_s),
      white_frequency_hz_(white_deviation(force_density(instrument), 1.0 / dt_s) / kTwoPi),
      phase_rad_(white_deviation(pickoff_density(instrument), 1.0 / kOutputInterval_s)),
      oscillator_(white_deviation(instrument.oscillator_noise_rthz, 1.0 / dt_s)),
      rebalance_(loop(instrument, options.loops.rebalance_hz, dt_s, options.seed, kRebalance)),
      quadrature_(loop(instrument, options.loops.quadrature_hz, dt_s, options.seed, kQuadrature)),
      amplitude_(loop(instrument, options.loops.amplitude_hz, dt_s, options.seed, kAmplitude)),
      gaussian_(options.seed, kOther) {
  former_phase_rad_ = phase_rad_ * gaussian_();
  if (instrument.rate_flicker_dph > 0.0) {
    flicker_.emplace(FlickerNoise::h_of_floor(instrument.rate_flicker_dph), kFlickerLowestHz, 0.5 / dt_s,
                     options.seed, kFlicker);
  }
}

void SlowTwinNoise::add(const Parameters& p, double amplitude, TelemetrySample& sample) {
  const double phase_rad = phase_rad_ * gaussian_();
  const double frequency_hz =
      white_frequency_hz_ * gaussian_() + (phase_rad - former_phase_rad_) / (kTwoPi * dt_s_);
  former_phase_rad_ = phase_rad;
  sample.frequency_hz += frequency_hz / amplitude;
  if (oscillator_ > 0.0) sample.frequency_hz -= sample.frequency_hz * oscillator_ * gaussian_();

  rebalance_.advance();
  quadrature_.advance();
  amplitude_.advance();
  sample.rate_dph +=
      rebalance_.command_per_s() / p.rebalance_per_s * instrument_.rebalance_full_scale_dps * 3600.0;
  sample.quadrature_v +=
      2.0 * quadrature_.command_per_s() / p.quadrature_span_rad_s * instrument_.quadrature_full_scale_v;
  sample.drive_v += amplitude_.command_per_s() / p.drive_per_s * instrument_.drive_full_scale_v;
  sample.amplitude += amplitude_.measured();
  if (flicker_) sample.rate_dph += flicker_->advance(dt_s_);

  sample.case_temp_degc += instrument_.case_thermometer_noise_degc * gaussian_();
  const double step_degc = instrument_.case_thermometer_step_degc;
  if (step_degc > 0.0) sample.case_temp_degc = step_degc * std::round(sample.case_temp_degc / step_degc);
}

}  // namespace hemi::physics

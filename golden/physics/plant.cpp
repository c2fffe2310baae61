// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/plant.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace hemi::physics {

namespace {

constexpr double kFlickerHighestHz = 100.0;

enum NoiseStream : std::uint64_t { kPickoff, kForce, kOscillator, kRateFlicker };

const PlantConfiguration& checked(const PlantConfiguration& c) {
  if (c.adc.bits < 16 || c.adc.bits > 24) throw std::invalid_argument("plant: an ADC has 16 to 24 bits");
  if (!(c.adc.rate_hz > 0.0)) throw std::invalid_argument("plant: the ADC's rate must be positive");
  if (!(c.update_s > 0.0)) throw std::invalid_argument("plant: the update interval must be positive");
  return c;
}

Motion motion_of(const InitialVibration& v, double omega_rad_s) {
  return {v.x_amplitude * std::cos(v.x_phase_rad), -v.x_amplitude * omega_rad_s * std::sin(v.x_phase_rad),
          v.y_amplitude * std::cos(v.y_phase_rad), -v.y_amplitude * omega_rad_s * std::sin(v.y_phase_rad)};
}

}  // namespace

Plant::Plant(const Instrument& instrument, ParameterSource source, const PlantConfiguration& c)
    : instrument_(instrument),
      source_(std::move(source)),
      nominal_omega_rad_s_(instrument.at(kReferenceDegc).omega_rad_s),
      period_s_(1.0 / checked(c).adc.rate_hz),
      resonator_(instrument.at(kReferenceDegc), period_s_, nominal_omega_rad_s_),
      update_start_s_(c.start_s),
      samples_an_update_(std::max(1, static_cast<int>(std::lround(c.update_s * c.adc.rate_hz)))),
      adc_x_(c.adc.bits),
      adc_y_(c.adc.bits),
      pickoff_noise_(c.seed, kPickoff),
      force_noise_(c.seed, kForce),
      oscillator_noise_(c.seed, kOscillator),
      rate_flicker_(FlickerNoise::h_of_floor(instrument.rate_flicker_dph * kRadPerSecondPerDph),
                    kFlickerLowestHz, kFlickerHighestHz, c.seed, kRateFlicker),
      // the same volts a root hertz at every rate
      pickoff_deviation_codes_(instrument.pickoff_noise_lsb * adc_x_.codes_per_lsb16() *
                               std::sqrt(c.adc.rate_hz / AdcConfiguration::reference().rate_hz)),
      push_deviation_(instrument.kappa * instrument.force_noise_dph_rthz * kRadPerSecondPerDph *
                      std::sqrt(kSamplesAPush * period_s_)),
      oscillator_deviation_(
          white_deviation(instrument.oscillator_noise_rthz, c.adc.rate_hz / samples_an_update_)) {
  samples_left_ = samples_an_update_;
  update();
  resonator_.set_motion(motion_of(c.start, parameters_.omega_rad_s));
}

Plant::Plant(const Instrument& instrument, const Parameters& constant,
             const PlantConfiguration& configuration)
    : Plant(
          instrument, [constant](double, double) { return constant; }, configuration) {}

void Plant::update() {
  const double middle_s = update_start_s_ + 0.5 * samples_an_update_ * period_s_;
  Parameters next = source_(middle_s, resonator_.amplitude());
  if (instrument_.rate_flicker_dph > 0.0)
    next.rate_rad_s += rate_flicker_.advance(samples_an_update_ * period_s_);
  if (oscillator_deviation_ > 0.0) next.oscillator_error += oscillator_deviation_ * oscillator_noise_();
  if (next == parameters_) return;
  parameters_ = next;
  step_s_ = period_s_ * (1.0 - next.oscillator_error);
  resonator_.set(next, step_s_);
  set_electronics();
}

void Plant::set_electronics() {
  const Parameters& p = parameters_;
  drive_x_ = 2.0 * p.omega_rad_s * p.drive_per_s;
  drive_y_ = drive_x_ * p.forcer_misalignment_rad;
  rebalance_y_ = 2.0 * p.omega_rad_s * p.rebalance_per_s;
  pickoff_x_.gain = instrument_.pickoff_full_scale_per_amplitude * p.pickoff_gain_x;
  pickoff_y_.gain = instrument_.pickoff_full_scale_per_amplitude * p.pickoff_gain_y;
  pickoff_y_.in_phase = std::cos(p.pickoff_phase_y_rad);
  pickoff_y_.lead = std::sin(p.pickoff_phase_y_rad) * nominal_omega_rad_s_ / p.omega_rad_s;
  quadratic_ = p.pickoff_quadratic;
  cubic_ = p.pickoff_cubic;
  adc_x_.set(p.adc_offset_lsb[0], p.adc_inl_lsb, p.adc_clip);
  adc_y_.set(p.adc_offset_lsb[1], p.adc_inl_lsb, p.adc_clip);
}

}  // namespace hemi::physics

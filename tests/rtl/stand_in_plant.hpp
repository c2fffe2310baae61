// SPDX-License-Identifier: Apache-2.0
// A plant for comparing engines in closed loop: two coupled rotating phasors, far quicker than any resonator,
// and a script of faults that leads the core through all of its states.
#ifndef HEMI_TESTS_RTL_STAND_IN_PLANT_HPP
#define HEMI_TESTS_RTL_STAND_IN_PLANT_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <random>

#include "tb/plant_port.hpp"
#include "tests/tb/signals.hpp"

namespace hemi::tests {

/// Per sample, p primary and q secondary, pickoffs Re p and Re q, forces F on the velocity -Im:
///
///   p' = r p + rate q - j gain F_drive,   q' = r q - rate p + j (cross - gain u) p - j gain F_rebalance
///
/// r = (1 - damping) e^(j 2 pi f / fs), u the quadrature actuator. Words act from the second sample after
/// theirs on.
class StandInPlant : public tb::PlantPort {
 public:
  StandInPlant(bool wide, unsigned seed) : wide_(wide), generator_(seed) {}

  tb::SamplePair sample() override {
    follow_script();
    const double rail = std::ldexp(1.0, adc_bits() - 1);
    const auto adc = [&](double v) {
      return static_cast<std::int32_t>(
          std::clamp(std::floor(v * rail + noise_(generator_)), -rail, rail - 1));
    };
    const double seen = connected_ ? 1.0 : 0.0;
    return {adc(seen * p_.real()), adc(seen * q_.real()), count_ % 60000 == 59999};
  }

  void act(const tb::DacWords& words) override {
    const std::complex<double> j(0, 1);
    const std::complex<double> turn =
        std::polar(1 - 1e-4, 2 * std::numbers::pi * frequency_hz_ / sample_rate_hz());
    const tb::DacWords acting = line_[0];
    line_ = {line_[1], words};
    const auto force = [](std::int32_t word) { return gain * std::ldexp(word, -15); };
    const std::complex<double> p = p_, q = q_;
    p_ = turn * p + rate_ * q - j * force(acting.drive);
    q_ = turn * q - rate_ * p + j * (cross_ - 0.1 * force(acting.quadrature)) * p -
         j * force(acting.rebalance);
    const double amplitude = std::abs(p_);
    if (amplitude > 1.5) p_ *= 1.5 / amplitude;  // a shell has its limits, too
    ++count_;
  }

  /// Samples until the script begins again.
  static constexpr std::uint64_t script_samples(bool wide) { return wide ? 250000 : 100000; }

 private:
  static constexpr double gain = 1e-3;

  int adc_bits() const { return wide_ ? config::Wide::adc_bits : config::Reference::adc_bits; }
  double sample_rate_hz() const { return wide_ ? config::Wide::adc_rate_hz : config::Reference::adc_rate_hz; }

  void follow_script() {
    const double t = static_cast<double>(count_ % script_samples(wide_)) / sample_rate_hz();
    const auto during = [t](double from, double to) { return t >= from && t < to; };
    frequency_hz_ = during(0.55, 0.62) ? 4525.0 : 4470.0;  // lock is lost and found again
    // A hold-over; losses before the lock and in operation.
    connected_ = !during(0.35, 0.353) && !during(0.447, 0.45) && !during(0.95, 0.96);
    // And one while the amplitude rises for the first time.
    if (silent_until_ == 0 && std::abs(p_) > 0.5)
      silent_until_ = count_ + static_cast<std::uint64_t>(0.008 * sample_rate_hz());
    connected_ = connected_ && count_ >= silent_until_;
    rate_ = during(0.42, 0.46) ? 1.2e-3 : during(0.46, 0.50) ? -9e-4 : 1e-5;  // beyond the actuator
    cross_ = during(0.50, 0.53) ? 2e-4 : 1e-5;
  }

  bool wide_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> noise_{0.5, 1.0};
  std::complex<double> p_{1e-4, 0}, q_{0, 0};
  std::array<tb::DacWords, 2> line_{};
  std::uint64_t count_ = 0;
  std::uint64_t silent_until_ = 0;
  double frequency_hz_ = 0, rate_ = 0, cross_ = 0;
  bool connected_ = true;
};

/// busy_control for this plant: a quick phase loop, the pickoffs' own phase.
inline tb::RegisterValues stand_in_registers(bool wide) {
  auto values = busy_control(busy_registers(wide, 4410.0));
  const double fs = wide ? config::Wide::adc_rate_hz : config::Reference::adc_rate_hz;
  const double wn = 2 * std::numbers::pi * 24 / 2.482;
  values[config::reg_loop_proportional] = 2 * wn / fs;
  values[config::reg_loop_integral] =
      wn * wn / (fs * fs / (wide ? config::Wide::decimation : config::Reference::decimation));
  values[config::reg_lock_count] = 40;
  values[config::reg_search_ticks] = 40;
  values[config::reg_closing_amplitude] = 0.3;
  values[config::reg_quadrature_limit] = 0.1;
  values[config::reg_rebalance_limit] = 0.3;
  values[config::reg_demodulation_cos] = 0.995;
  values[config::reg_demodulation_sin] = -0.0998;
  return values;
}

/// Random levels and counts of the start-up that a tone of 0.8 reaches.
inline void set_quick_start_up(tb::RegisterValues& values, std::mt19937_64& generator) {
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(generator);
  };
  values[config::reg_control] = 1;
  values[config::reg_search_amplitude] = between(0.001, 0.1);
  values[config::reg_closing_amplitude] = between(0.1, 0.35);
  values[config::reg_search_ticks] = between(1, 20);
  values[config::reg_holdover_ticks] = between(1, 20);
}

}  // namespace hemi::tests

#endif  // HEMI_TESTS_RTL_STAND_IN_PLANT_HPP

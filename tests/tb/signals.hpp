// SPDX-License-Identifier: Apache-2.0
// Stimuli that every comparison of engines uses.
#ifndef HEMI_TESTS_TB_SIGNALS_HPP
#define HEMI_TESTS_TB_SIGNALS_HPP

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tb/engine.hpp"

namespace hemi::tests {

/// Registers that make every block work on numbers of its own: nothing zero, nothing one.
inline tb::RegisterValues busy_registers(bool wide, double start_hz) {
  const double fs = wide ? config::Wide::adc_rate_hz : config::Reference::adc_rate_hz;
  const double decimation = wide ? config::Wide::decimation : config::Reference::decimation;
  const double wn = 2 * std::numbers::pi * 10 / 2.482;
  tb::RegisterValues v{};
  v[config::reg_nco_start] = start_hz / fs;
  v[config::reg_loop_proportional] = 2 * wn / fs;
  v[config::reg_loop_integral] = wn * wn / (fs * fs / decimation);
  v[config::reg_loop_frequency] = 1 / (32 * decimation);
  v[config::reg_amplitude_threshold] = 1e-3;
  v[config::reg_lock_count] = 200;
  v[config::reg_demodulation_cos] = 0.8;
  v[config::reg_demodulation_sin] = 0.6;
  v[config::reg_rate_gain] = 1.37;
  v[config::reg_frequency_reference] = 4432.07;
  v[config::reg_log2_block] = 1;
  v[config::reg_slope_shift] = 10;
  v[config::reg_slope_gain] = 0.7;
  const double thermometer[6] = {20.1, 173.3, 12.7, -8.9, 3.3, -1.1};
  const double bias[10] = {3.1, -20.5, 17.2, 40.4, 105.7, -33.8, 21.1, 15.5, -9.6, 12.3};
  for (int i = 0; i < 6; ++i) v[config::reg_thermometer_0 + i] = thermometer[i];
  for (int i = 0; i < 10; ++i) v[config::reg_bias_0 + i] = bias[i];
  v[config::reg_scale_correction] = 0.0031;
  v[config::reg_calibrated_low] = -0.3;
  v[config::reg_calibrated_high] = 0.2;
  return v;
}

/// The same in force-to-rebalance mode, with limits that are reached and a start-up that is short. The
/// capture does not answer to the actuators, so every loop runs into its limit, holds, and starts again.
inline tb::RegisterValues busy_control(tb::RegisterValues v) {
  const double step = 0.01 * v[config::reg_nco_start];
  v[config::reg_control] = 1;
  v[config::reg_search_amplitude] = 0.05;
  v[config::reg_closing_amplitude] = 0.2;
  v[config::reg_search_ticks] = 8;
  v[config::reg_search_step] = step;
  v[config::reg_search_span] = 2 * step;
  v[config::reg_holdover_ticks] = 25;
  v[config::reg_modulation_phase] = 0.137;
  v[config::reg_modulation_delay] = 2.513;
  v[config::reg_amplitude_setpoint] = 0.4;
  v[config::reg_amplitude_proportional] = 3.7;
  v[config::reg_amplitude_integral] = 0.0041;
  v[config::reg_drive_start] = 0.021;
  v[config::reg_drive_limit] = 0.93;
  v[config::reg_quadrature_proportional] = 1.9;
  v[config::reg_quadrature_integral] = 0.0123;
  v[config::reg_quadrature_start] = -0.057;
  v[config::reg_quadrature_limit] = 0.71;
  v[config::reg_rebalance_proportional] = 2.3;
  v[config::reg_rebalance_integral] = 0.0567;
  v[config::reg_rebalance_limit] = 1.27;
  return v;
}

/// What a stretch of a capture is made of.
enum class Stretch { tone, silence, overdriven, random_rails, full_scale_noise };

/// Adds `n` pairs of a tone of `hz` in noise of `noise_lsb` rms (primary 0.8, secondary 0.3 of full scale),
/// or of something hostile.
inline void append(std::vector<tb::SamplePair>& pairs, Stretch kind, std::size_t n, bool wide, double hz,
                   double noise_lsb, std::mt19937_64& generator) {
  const double fs = wide ? config::Wide::adc_rate_hz : config::Reference::adc_rate_hz;
  const double rail = std::ldexp(1.0, (wide ? config::Wide::adc_bits : config::Reference::adc_bits) - 1);
  std::normal_distribution<double> noise(0.0, noise_lsb);
  std::uniform_real_distribution<double> uniform(-rail, rail);
  const auto adc = [&](double v) {
    return static_cast<std::int32_t>(std::clamp(std::floor(v + 0.5), -rail, rail - 1));
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double theta = 2 * std::numbers::pi * std::fmod(hz / fs * static_cast<double>(pairs.size()), 1.0);
    tb::SamplePair pair;
    switch (kind) {
      case Stretch::tone:
        pair = {adc(0.8 * rail * std::cos(theta + 1) + noise(generator)),
                adc(0.3 * rail * std::cos(theta + 2) + noise(generator)), false};
        break;
      case Stretch::silence:
        pair = {adc(noise(generator)), adc(noise(generator)), false};
        break;
      case Stretch::overdriven:
        pair = {adc(3 * rail * std::cos(theta + 1)), adc(3 * rail * std::sin(theta)), false};
        break;
      case Stretch::random_rails:
        pair = {adc(uniform(generator) > 0 ? rail : -rail), adc(uniform(generator) > 0 ? rail : -rail),
                false};
        break;
      case Stretch::full_scale_noise:
        pair = {adc(uniform(generator)), adc(uniform(generator)), false};
        break;
    }
    pair.gap = (pairs.size() + 1) % 77777 == 0;
    pairs.push_back(pair);
  }
}

/// Tone, then every hostile stretch with the tone between, so that lock is lost and found again.
inline std::vector<tb::SamplePair> hostile_capture(bool wide, std::size_t unit, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::vector<tb::SamplePair> pairs;
  append(pairs, Stretch::tone, 6 * unit, wide, 4425.0, 3.0, generator);
  for (const Stretch kind :
       {Stretch::silence, Stretch::overdriven, Stretch::random_rails, Stretch::full_scale_noise}) {
    append(pairs, kind, unit, wide, 4425.0, 0.5, generator);
    append(pairs, Stretch::tone, 2 * unit, wide, 4432.0, 3.0, generator);
  }
  return pairs;
}

}  // namespace hemi::tests

#endif  // HEMI_TESTS_TB_SIGNALS_HPP

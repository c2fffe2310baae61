// SPDX-License-Identifier: Apache-2.0
// The coefficient registers as typed words; formats, units and meanings stand in hls/config.hpp.
#ifndef HEMI_HLS_REGISTERS_HPP
#define HEMI_HLS_REGISTERS_HPP

#include "hls/words.hpp"

namespace hemi {
namespace hls {

struct Registers {
  Increment nco_start;
  RegisterWord<config::reg_loop_proportional> loop_proportional;
  RegisterWord<config::reg_loop_integral> loop_integral;
  RegisterWord<config::reg_loop_frequency> loop_frequency;
  CordicWord amplitude_threshold;
  RegisterWord<config::reg_lock_count> lock_count;
  RegisterWord<config::reg_demodulation_cos> demodulation_cos;
  RegisterWord<config::reg_demodulation_sin> demodulation_sin;
  RegisterWord<config::reg_rate_gain> rate_gain;
  Frequency frequency_reference;
  std::int32_t log2_block = 0;
  std::int32_t slope_shift = 0;
  RegisterWord<config::reg_slope_gain> slope_gain;
  Temperature thermometer[6];
  Bias bias[10];  ///< in the order of config::RegisterIndex: 1, f, f2, f3, df, df2, df3, f df, f2 df, f df2
  RegisterWord<config::reg_scale_correction> scale_correction;
  Offset calibrated_low, calibrated_high;
  std::int32_t control = 0;
  CordicWord search_amplitude, closing_amplitude;
  std::int32_t search_ticks = 0;
  Increment search_step, search_span;
  std::int32_t holdover_ticks = 0;
  Angle modulation_phase;
  RegisterWord<config::reg_modulation_delay> modulation_delay;
  CordicWord amplitude_setpoint;
  RegisterWord<config::reg_amplitude_proportional> amplitude_proportional;
  RegisterWord<config::reg_amplitude_integral> amplitude_integral;
  Command drive_start, drive_limit;
  RegisterWord<config::reg_quadrature_proportional> quadrature_proportional;
  RegisterWord<config::reg_quadrature_integral> quadrature_integral;
  Command quadrature_start, quadrature_limit;
  RegisterWord<config::reg_rebalance_proportional> rebalance_proportional;
  RegisterWord<config::reg_rebalance_integral> rebalance_integral;
  Command rebalance_limit;
  bool parity_error = false;

  /// Takes over all words at once; words wider than their format lose their upper bits.
  void load(const std::int64_t (&image)[config::register_count]) {
    nco_start = from_raw<Increment>(image[config::reg_nco_start]);
    take(loop_proportional, image[config::reg_loop_proportional]);
    take(loop_integral, image[config::reg_loop_integral]);
    take(loop_frequency, image[config::reg_loop_frequency]);
    take(amplitude_threshold, image[config::reg_amplitude_threshold]);
    take(lock_count, image[config::reg_lock_count]);
    take(demodulation_cos, image[config::reg_demodulation_cos]);
    take(demodulation_sin, image[config::reg_demodulation_sin]);
    take(rate_gain, image[config::reg_rate_gain]);
    take(frequency_reference, image[config::reg_frequency_reference]);
    log2_block = static_cast<std::int32_t>(image[config::reg_log2_block] & 15);
    slope_shift = static_cast<std::int32_t>(image[config::reg_slope_shift] & 63);
    take(slope_gain, image[config::reg_slope_gain]);
    for (int i = 0; i < 6; ++i) take(thermometer[i], image[config::reg_thermometer_0 + i]);
    for (int i = 0; i < 10; ++i) take(bias[i], image[config::reg_bias_0 + i]);
    take(scale_correction, image[config::reg_scale_correction]);
    take(calibrated_low, image[config::reg_calibrated_low]);
    take(calibrated_high, image[config::reg_calibrated_high]);
    load_loops(image);
    parity_error = fold(image) != 0;
  }

 private:
  void load_loops(const std::int64_t (&image)[config::register_count]) {
    control = static_cast<std::int32_t>(image[config::reg_control] & 1);
    take(search_amplitude, image[config::reg_search_amplitude]);
    take(closing_amplitude, image[config::reg_closing_amplitude]);
    search_ticks = count<config::reg_search_ticks>(image);
    take(search_step, image[config::reg_search_step]);
    take(search_span, image[config::reg_search_span]);
    holdover_ticks = count<config::reg_holdover_ticks>(image);
    take(modulation_phase, image[config::reg_modulation_phase]);
    take(modulation_delay, image[config::reg_modulation_delay]);
    take(amplitude_setpoint, image[config::reg_amplitude_setpoint]);
    take(amplitude_proportional, image[config::reg_amplitude_proportional]);
    take(amplitude_integral, image[config::reg_amplitude_integral]);
    take(drive_start, image[config::reg_drive_start]);
    take(drive_limit, image[config::reg_drive_limit]);
    take(quadrature_proportional, image[config::reg_quadrature_proportional]);
    take(quadrature_integral, image[config::reg_quadrature_integral]);
    take(quadrature_start, image[config::reg_quadrature_start]);
    take(quadrature_limit, image[config::reg_quadrature_limit]);
    take(rebalance_proportional, image[config::reg_rebalance_proportional]);
    take(rebalance_integral, image[config::reg_rebalance_integral]);
    take(rebalance_limit, image[config::reg_rebalance_limit]);
  }

  template <int Index>
  static std::int32_t count(const std::int64_t (&image)[config::register_count]) {
    return static_cast<std::int32_t>(raw(from_raw<RegisterWord<Index>>(image[Index])));
  }

  template <class T>
  static void take(T& word, std::int64_t value) {
    word = from_raw<T>(value);
  }

  /// Exclusive or of all words over 54 bits: 0 when the parity register is right.
  static std::int64_t fold(const std::int64_t (&image)[config::register_count]) {
    std::int64_t x = 0;
    for (int i = 0; i < config::register_count; ++i) x ^= image[i];
    return x & ((std::int64_t{1} << config::registers[config::reg_parity].format.width) - 1);
  }
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_REGISTERS_HPP

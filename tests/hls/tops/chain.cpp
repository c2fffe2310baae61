// SPDX-License-Identifier: Apache-2.0
#include "tests/hls/tops/chain.hpp"

#include "hls/start_up.hpp"
#include "hls/tops/tops.hpp"

// A top is recorded under its own name.
#define HEMI_CALL(top, ...) call_(#top, top, __VA_ARGS__)

namespace hemi::tests {

using hls::from_raw;
using hls::raw;

void TopChain::reset(const tb::RegisterImage& image) {
  image_ = image;
  std::int64_t words[config::register_count];
  for (int i = 0; i < config::register_count; ++i) words[i] = image[i];
  registers_ = hls::Registers();
  registers_.load(words);
  std::int64_t wide[3];
  std::int32_t narrow[5];
  bool flag[3];
  HEMI_CALL(hemi_nco, true, 0, &wide[0], &narrow[0], &narrow[1]);
  HEMI_CALL(hemi_cic, true, false, 0, 0, 0, 0, &narrow[0], &narrow[1], &narrow[2], &narrow[3]);
  HEMI_CALL(hemi_modulator, true, false, 0, 0, 0, 0, 0, 0, 0, &narrow[0], &narrow[1], &narrow[2], &narrow[3],
            &narrow[4]);
  HEMI_CALL(hemi_image_filter, true, 0, 0, 0, 0, &narrow[0], &narrow[1], &narrow[2], &narrow[3]);
  HEMI_CALL(hemi_start_up, true, 0, false, false, 0, 0, 0, 0, 0, 0, 0, 0, &narrow[0], &flag[0], &wide[0],
            &narrow[1], &narrow[2], &narrow[3]);
  HEMI_CALL(hemi_reference_phase_loop, true, false, reg(config::reg_nco_start), 0, 0, 0, 0, 0, 0, 0, &wide[0],
            &wide[1], &narrow[0], &flag[0], &flag[1], &flag[2]);
  HEMI_CALL(hemi_amplitude_loop, true, 0, 0, 0, 0, 0, 0, &wide[0], &narrow[0], &flag[0]);
  HEMI_CALL(hemi_quadrature_loop, true, 0, 0, 0, 0, 0, 0, &wide[0], &narrow[0], &flag[0]);
  HEMI_CALL(hemi_rebalance_loop, true, 0, 0, 0, 0, 0, &wide[0], &narrow[0], &flag[0]);
  HEMI_CALL(hemi_frequency_tracker, true, false, 0, 0, 0, &wide[0], &wide[1], &wide[2], &wide[0]);
  HEMI_CALL(hemi_rate_filter, true, false, false, 0, 0, 0, &wide[0], &wide[1], &flag[0]);
  HEMI_CALL(hemi_derivative, true, false, 0, 0, 0, 0, 0, &narrow[0], &wide[0], &flag[0], &flag[1]);
  HEMI_CALL(hemi_status, true, 0, &wide[0]);
  increment_ = pending_increment_ = reg(config::reg_nco_start);
  locked_ = false;
  raised_ = 0;
  drive_sum_ = last_drive_sum_ = quadrature_sum_ = last_quadrature_sum_ = hls::CommandSum();
  dac_ = {};
  samples_ = ticks_ = outputs_ = 0;
}

void TopChain::raise(config::StatusBit bit, bool condition) {
  if (condition) raised_ |= std::int32_t{1} << bit;
}

std::optional<TopChain::Words> TopChain::sample(std::int32_t x, std::int32_t y, bool gap) {
  constexpr std::int32_t rail = std::int32_t{1} << (config::Reference::adc_bits - 1);
  const bool tick = samples_ + 1 == config::Reference::decimation;
  samples_ = tick ? 0 : samples_ + 1;
  raise(config::status_adc_overload, x == rail - 1 || x == -rail || y == rail - 1 || y == -rail);
  raise(config::status_sample_gap, gap);

  std::int64_t phase;
  std::int32_t cosine, sine;
  HEMI_CALL(hemi_nco, false, increment_, &phase, &cosine, &sine);
  taps_.tap(config::tap_phase, phase);
  taps_.tap(config::tap_cos, cosine);
  taps_.tap(config::tap_sin, sine);
  Channels product, decimated;
  HEMI_CALL(hemi_demodulator, x, y, cosine, sine, &product.xi, &product.xq, &product.yi, &product.yq);
  taps_.tap(config::tap_product_xi, product.xi);
  taps_.tap(config::tap_product_xq, product.xq);
  taps_.tap(config::tap_product_yi, product.yi);
  taps_.tap(config::tap_product_yq, product.yq);
  HEMI_CALL(hemi_cic, false, tick, product.xi, product.xq, product.yi, product.yq, &decimated.xi,
            &decimated.xq, &decimated.yi, &decimated.yq);

  const bool output_due = tick && ticks_ + 1 == config::ticks_per_output;
  Commands commands;
  if (tick) {
    ticks_ = output_due ? 0 : ticks_ + 1;
    const std::int64_t after =
        raw(hls::wrap_add(from_raw<hls::Phase>(phase), from_raw<hls::Increment>(increment_)));
    increment_ = pending_increment_;
    const Polar polar = detect(decimated);
    commands = close_loops(polar);
    track(after, polar, commands, output_due);
  }
  std::int32_t carrier, carrier_offset;
  HEMI_CALL(hemi_modulator, false, tick, phase, commands.drive, commands.rebalance, commands.quadrature,
            pending_increment_, reg(config::reg_modulation_phase), reg(config::reg_modulation_delay),
            &carrier, &dac_.drive, &dac_.rebalance, &dac_.quadrature, &carrier_offset);
  taps_.tap(config::tap_carrier, carrier);
  taps_.tap(config::tap_dac_drive, dac_.drive);
  taps_.tap(config::tap_dac_rebalance, dac_.rebalance);
  if (tick) taps_.tap(config::tap_carrier_offset, carrier_offset);
  if (!output_due) return std::nullopt;
  return output();
}

TopChain::Polar TopChain::detect(const Channels& decimated) {
  taps_.tap(config::tap_cic_xi, decimated.xi);
  taps_.tap(config::tap_cic_xq, decimated.xq);
  taps_.tap(config::tap_cic_yi, decimated.yi);
  taps_.tap(config::tap_cic_yq, decimated.yq);
  Channels baseband;
  HEMI_CALL(hemi_image_filter, false, decimated.xi, decimated.xq, decimated.yi, decimated.yq, &baseband.xi,
            &baseband.xq, &baseband.yi, &baseband.yq);
  taps_.tap(config::tap_baseband_xi, baseband.xi);
  taps_.tap(config::tap_baseband_xq, baseband.xq);
  taps_.tap(config::tap_baseband_yi, baseband.yi);
  taps_.tap(config::tap_baseband_yq, baseband.yq);
  Polar polar;
  bool saturated;
  HEMI_CALL(hemi_phase_detector, baseband.xi, baseband.xq, baseband.yi, baseband.yq,
            reg(config::reg_demodulation_cos), reg(config::reg_demodulation_sin), &polar.amplitude,
            &polar.phase_error, &polar.in_phase, &polar.quadrature, &saturated);
  raise(config::status_secondary_saturated, saturated);
  taps_.tap(config::tap_amplitude, polar.amplitude);
  taps_.tap(config::tap_phase_error, polar.phase_error);
  taps_.tap(config::tap_secondary_in_phase, polar.in_phase);
  taps_.tap(config::tap_secondary_quadrature, polar.quadrature);
  return polar;
}

TopChain::Commands TopChain::close_loops(const Polar& polar) {
  using hls::Baseband, hls::Clipped, hls::quantise;
  std::int32_t state, mode_amplitude, mode_quadrature, mode_rebalance, counter;
  std::int64_t start, integral;
  bool restart, holdover, saturated;
  HEMI_CALL(hemi_start_up, false, polar.amplitude, locked_, registers_.control != 0,
            reg(config::reg_amplitude_threshold), reg(config::reg_search_amplitude),
            reg(config::reg_closing_amplitude), reg(config::reg_search_ticks), reg(config::reg_nco_start),
            reg(config::reg_search_step), reg(config::reg_search_span), reg(config::reg_holdover_ticks),
            &state, &restart, &start, &mode_amplitude, &mode_quadrature, &mode_rebalance);
  taps_.tap(config::tap_state, state);
  HEMI_CALL(hemi_reference_phase_loop, false, restart, start, polar.amplitude, polar.phase_error,
            reg(config::reg_loop_proportional), reg(config::reg_loop_integral),
            reg(config::reg_loop_frequency), reg(config::reg_amplitude_threshold),
            reg(config::reg_lock_count), &pending_increment_, &integral, &counter, &locked_, &holdover,
            &saturated);
  taps_.tap(config::tap_loop_integral, integral);
  taps_.tap(config::tap_loop_increment, pending_increment_);
  taps_.tap(config::tap_lock_counter, counter);
  raise(config::status_loop_saturated, saturated);
  raise(config::status_unlocked, !locked_);
  raise(config::status_holdover, holdover);
  raise(config::status_searching, state == config::state_search);
  raise(config::status_starting, state != config::state_open && state != config::state_run);

  Commands commands;
  const auto amplitude_error = quantise<Baseband>(quantise<Clipped<config::baseband>>(
      registers_.amplitude_setpoint - from_raw<hls::CordicWord>(polar.amplitude)));
  const auto rebalance_error =
      quantise<Baseband>(quantise<Clipped<config::baseband>>(-from_raw<Baseband>(polar.in_phase)));
  HEMI_CALL(hemi_amplitude_loop, false, mode_amplitude, raw(amplitude_error),
            reg(config::reg_amplitude_proportional), reg(config::reg_amplitude_integral),
            reg(config::reg_drive_start), reg(config::reg_drive_limit), &integral, &commands.drive,
            &saturated);
  raise(config::status_drive_saturated, saturated);
  if (state == config::state_search) commands.drive = static_cast<std::int32_t>(raw(registers_.drive_limit));
  taps_.tap(config::tap_drive_integral, integral);
  taps_.tap(config::tap_drive, commands.drive);
  HEMI_CALL(hemi_quadrature_loop, false, mode_quadrature, polar.quadrature,
            reg(config::reg_quadrature_proportional), reg(config::reg_quadrature_integral),
            reg(config::reg_quadrature_start), reg(config::reg_quadrature_limit), &integral,
            &commands.quadrature, &saturated);
  raise(config::status_quadrature_saturated, saturated);
  taps_.tap(config::tap_quadrature_integral, integral);
  taps_.tap(config::tap_quadrature, commands.quadrature);
  HEMI_CALL(hemi_rebalance_loop, false, mode_rebalance, raw(rebalance_error),
            reg(config::reg_rebalance_proportional), reg(config::reg_rebalance_integral),
            reg(config::reg_rebalance_limit), &integral, &commands.rebalance, &saturated);
  raise(config::status_rebalance_saturated, saturated);
  taps_.tap(config::tap_rebalance_integral, integral);
  taps_.tap(config::tap_rebalance, commands.rebalance);
  drive_sum_ = hls::wrap_add(drive_sum_, from_raw<hls::Command>(commands.drive));
  quadrature_sum_ = hls::wrap_add(quadrature_sum_, from_raw<hls::Command>(commands.quadrature));
  return commands;
}

void TopChain::track(std::int64_t phase, const Polar& polar, const Commands& commands, bool output) {
  std::int64_t tick_phase, rate_tick;
  bool saturated;
  HEMI_CALL(hemi_frequency_tracker, false, output, phase, polar.amplitude, polar.phase_error, &tick_phase,
            &frequency_, &amplitude_sum_, &phase_error_sum_);
  taps_.tap(config::tap_tick_phase, tick_phase);
  HEMI_CALL(hemi_rate_filter, false, output, registers_.control != 0, polar.in_phase, commands.rebalance,
            reg(config::reg_rate_gain), &rate_tick, &rate_, &saturated);
  taps_.tap(config::tap_rate_tick, rate_tick);
  raise(config::status_rate_saturated, saturated);
}

TopChain::Words TopChain::output() {
  taps_.tap(config::tap_frequency, frequency_);
  taps_.tap(config::tap_rate, rate_);
  Words words{};
  words[config::word_amplitude] = amplitude_sum_;
  words[config::word_phase_error] = phase_error_sum_;
  words[config::word_drive] = raw(hls::over_two(drive_sum_, last_drive_sum_));
  words[config::word_quadrature] = raw(hls::over_two(quadrature_sum_, last_quadrature_sum_));
  const bool valid = outputs_ >= 2;
  if (!valid) ++outputs_;
  return finish(frequency_, rate_, valid, valid && locked_, words);
}

TopChain::Words TopChain::telemetry(std::int64_t frequency, std::int64_t rate, bool valid) {
  return finish(frequency, rate, valid, valid, Words{});
}

TopChain::Words TopChain::finish(std::int64_t frequency, std::int64_t rate, bool valid, bool good,
                                 Words words) {
  std::int32_t offset, temperature, derivative, bias;
  std::int64_t slope_sum, compensated, status;
  bool out_of_range, hot, slope_valid, steep, bias_saturated, compensation_saturated;
  const auto thermometer = [&](int i) { return image_[config::reg_thermometer_0 + i]; };
  HEMI_CALL(hemi_thermometer, frequency, reg(config::reg_frequency_reference), thermometer(0), thermometer(1),
            thermometer(2), thermometer(3), thermometer(4), thermometer(5), &offset, &temperature,
            &out_of_range, &hot);
  HEMI_CALL(hemi_derivative, false, good, frequency, reg(config::reg_frequency_reference),
            reg(config::reg_log2_block), reg(config::reg_slope_shift), reg(config::reg_slope_gain),
            &derivative, &slope_sum, &slope_valid, &steep);
  const auto k = [&](int i) { return image_[config::reg_bias_0 + i]; };
  HEMI_CALL(hemi_bias_model, offset, derivative, rate, k(0), k(1), k(2), k(3), k(4), k(5), k(6), k(7), k(8),
            k(9), reg(config::reg_scale_correction), &bias, &compensated, &bias_saturated,
            &compensation_saturated);
  raise(config::status_frequency_out_of_range, out_of_range);
  raise(config::status_thermometer_saturated, hot);
  raise(config::status_derivative_saturated, steep);
  raise(config::status_derivative_invalid, !slope_valid);
  raise(config::status_bias_saturated, bias_saturated);
  raise(config::status_compensation_saturated, compensation_saturated);
  raise(config::status_out_of_calibrated_range,
        offset < reg(config::reg_calibrated_low) || offset > reg(config::reg_calibrated_high));
  raise(config::status_parity_error, registers_.parity_error);
  raise(config::status_frequency_invalid, !valid);
  HEMI_CALL(hemi_status, false, raised_, &status);
  raised_ = 0;
  taps_.tap(config::tap_offset, offset);
  taps_.tap(config::tap_temperature, temperature);
  taps_.tap(config::tap_slope_sum, slope_sum);
  taps_.tap(config::tap_derivative, derivative);
  taps_.tap(config::tap_bias, bias);
  taps_.tap(config::tap_compensated, compensated);
  taps_.tap(config::tap_status, status);
  words[config::word_frequency] = frequency;
  words[config::word_temperature] = temperature;
  words[config::word_derivative] = derivative;
  words[config::word_bias] = bias;
  words[config::word_rate] = rate;
  words[config::word_compensated] = compensated;
  words[config::word_status] = status;
  return words;
}

}  // namespace hemi::tests

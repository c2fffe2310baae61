// SPDX-License-Identifier: Apache-2.0
// Tops of the kernels behind the loops: frequency and rate at each tick, compensation at each output.
#include "hls/bias_model.hpp"
#include "hls/derivative.hpp"
#include "hls/frequency_tracker.hpp"
#include "hls/rate_filter.hpp"
#include "hls/status.hpp"
#include "hls/thermometer.hpp"
#include "hls/tops/ports.hpp"
#include "hls/tops/tops.hpp"

using namespace hemi::hls;
namespace config = hemi::config;

HEMI_TOP_OUTPUT(tick_phase)
HEMI_TOP_OUTPUT(frequency)
HEMI_TOP_OUTPUT(amplitude_sum)
HEMI_TOP_OUTPUT(phase_error_sum)
extern "C" void hemi_frequency_tracker(bool reset, bool output, std::int64_t phase, std::int64_t amplitude,
                                       std::int32_t phase_error, std::int64_t* tick_phase,
                                       std::int64_t* frequency, std::int64_t* amplitude_sum,
                                       std::int64_t* phase_error_sum) {
  static FrequencyTracker tracker;
  std::int64_t tick = 0, hertz = 0, amplitudes = 0, errors = 0;
  if (reset) {
    tracker.reset();
  } else {
    const Polar polar = {from_raw<CordicWord>(amplitude), from_raw<Angle>(phase_error)};
    tick = raw(tracker.step(from_raw<Phase>(phase), polar));
    if (output) {
      hertz = raw(tracker.frequency());
      amplitudes = raw(tracker.amplitude());
      errors = raw(tracker.phase_error());
    }
  }
  *tick_phase = tick;
  *frequency = hertz;
  *amplitude_sum = amplitudes;
  *phase_error_sum = errors;
}

HEMI_TOP_OUTPUT(rate_tick)
HEMI_TOP_OUTPUT(rate)
HEMI_TOP_OUTPUT(saturated)
extern "C" void hemi_rate_filter(bool reset, bool output, bool control, std::int32_t in_phase,
                                 std::int32_t rebalance, std::int32_t rate_gain, std::int64_t* rate_tick,
                                 std::int64_t* rate, bool* saturated) {
  static RateFilter filter;
  std::int64_t tick = 0, turning = 0;
  bool clipped = false;
  if (reset) {
    filter.reset();
  } else {
    const auto gain = from_raw<RegisterWord<config::reg_rate_gain>>(rate_gain);
    tick = raw(control ? filter.step(from_raw<Command>(rebalance), gain, clipped)
                       : filter.step(from_raw<Baseband>(in_phase), gain, clipped));
    if (output) turning = raw(filter.rate(clipped));
  }
  *rate_tick = tick;
  *rate = turning;
  *saturated = clipped;
}

HEMI_TOP_OUTPUT(offset)
HEMI_TOP_OUTPUT(temperature)
HEMI_TOP_OUTPUT(out_of_range)
HEMI_TOP_OUTPUT(saturated)
extern "C" void hemi_thermometer(std::int64_t frequency, std::int64_t frequency_reference,
                                 std::int32_t thermometer_0, std::int32_t thermometer_1,
                                 std::int32_t thermometer_2, std::int32_t thermometer_3,
                                 std::int32_t thermometer_4, std::int32_t thermometer_5, std::int32_t* offset,
                                 std::int32_t* temperature, bool* out_of_range, bool* saturated) {
  const std::int32_t coefficients[6] = {thermometer_0, thermometer_1, thermometer_2,
                                        thermometer_3, thermometer_4, thermometer_5};
  Registers r;
  r.frequency_reference = from_raw<Frequency>(frequency_reference);
  for (int i = 0; i < 6; ++i) r.thermometer[i] = from_raw<Temperature>(coefficients[i]);
  bool outside = false, clipped = false;
  const Offset o = Thermometer::offset(Thermometer::difference(from_raw<Frequency>(frequency), r), outside);
  *offset = word(o);
  *temperature = word(Thermometer::temperature(o, r, clipped));
  *out_of_range = outside;
  *saturated = clipped;
}

HEMI_TOP_OUTPUT(derivative)
HEMI_TOP_OUTPUT(slope_sum)
HEMI_TOP_OUTPUT(valid)
HEMI_TOP_OUTPUT(saturated)
extern "C" void hemi_derivative(bool reset, bool good, std::int64_t frequency,
                                std::int64_t frequency_reference, std::int32_t log2_block,
                                std::int32_t slope_shift, std::int32_t slope_gain, std::int32_t* derivative,
                                std::int64_t* slope_sum, bool* valid, bool* saturated) {
  static DerivativeFilter filter;
  Registers r;
  r.frequency_reference = from_raw<Frequency>(frequency_reference);
  r.log2_block = log2_block & 15;
  r.slope_shift = slope_shift & 63;
  r.slope_gain = from_raw<RegisterWord<config::reg_slope_gain>>(slope_gain);
  Derivative slope;
  bool clipped = false;
  if (reset) {
    filter.reset();
  } else {
    slope = filter.step(Thermometer::difference(from_raw<Frequency>(frequency), r), good, r, clipped);
  }
  *derivative = word(slope);
  *slope_sum = raw(filter.slope_sum());
  *valid = filter.valid();
  *saturated = clipped;
}

HEMI_TOP_OUTPUT(bias)
HEMI_TOP_OUTPUT(compensated)
HEMI_TOP_OUTPUT(bias_saturated)
HEMI_TOP_OUTPUT(compensation_saturated)
extern "C" void hemi_bias_model(std::int32_t offset, std::int32_t derivative, std::int64_t rate,
                                std::int32_t bias_0, std::int32_t bias_f, std::int32_t bias_f2,
                                std::int32_t bias_f3, std::int32_t bias_df, std::int32_t bias_df2,
                                std::int32_t bias_df3, std::int32_t bias_f_df, std::int32_t bias_f2_df,
                                std::int32_t bias_f_df2, std::int32_t scale_correction, std::int32_t* bias,
                                std::int64_t* compensated, bool* bias_saturated,
                                bool* compensation_saturated) {
  const std::int32_t coefficients[10] = {bias_0,   bias_f,   bias_f2,   bias_f3,    bias_df,
                                         bias_df2, bias_df3, bias_f_df, bias_f2_df, bias_f_df2};
  Registers r;
  for (int i = 0; i < 10; ++i) r.bias[i] = from_raw<Bias>(coefficients[i]);
  r.scale_correction = from_raw<RegisterWord<config::reg_scale_correction>>(scale_correction);
  bool bias_clipped = false, rate_clipped = false;
  const Bias b = BiasModel::bias(from_raw<Offset>(offset), from_raw<Derivative>(derivative), r, bias_clipped);
  *bias = word(b);
  *compensated = raw(BiasModel::compensate(from_raw<Rate>(rate), b, r, rate_clipped));
  *bias_saturated = bias_clipped;
  *compensation_saturated = rate_clipped;
}

HEMI_TOP_OUTPUT(word)
extern "C" void hemi_status(bool reset, std::int32_t raised, std::int64_t* word) {
  static Status status;
  if (reset) {
    status.reset();
    *word = 0;
    return;
  }
  for (int i = 0; i < config::status_bits; ++i)
    status.raise(static_cast<config::StatusBit>(i), ((raised >> i) & 1) != 0);
  *word = status.close();
}

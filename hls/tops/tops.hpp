// SPDX-License-Identifier: Apache-2.0
//
// Top functions for HLS compilers: every kernel of the reference instrument by itself, and the whole core.
//
// A call is one sample, tick or output of the kernel; its state is inside. All words are raw (docs/chain.md
// gives their formats); flags are 0 or 1, some of them bytes (docs/hls.md says why). Every output is written
// at every call, but the record's words, which stay as they were while record_valid is 0. `reset` starts the
// state again and makes the other inputs of its call meaningless; coefficients are inputs and must stand
// still between resets, as registers do.
#ifndef HEMI_HLS_TOPS_TOPS_HPP
#define HEMI_HLS_TOPS_TOPS_HPP

#include <cstdint>

#include "hls/config.hpp"

extern "C" {

// ---- At each sample

/// Phase, cosine and sine of this sample; `increment` then moves the phase on.
void hemi_nco(bool reset, std::int64_t increment, std::int64_t* phase, std::int32_t* cosine,
              std::int32_t* sine);

/// Adc words x, y times cosine and sine: no state.
void hemi_demodulator(std::int32_t x, std::int32_t y, std::int32_t cosine, std::int32_t sine,
                      std::int32_t* xi, std::int32_t* xq, std::int32_t* yi, std::int32_t* yq);

/// Four channels; where `tick` is set the combs run behind the integrators, else the outputs are 0.
void hemi_cic(bool reset, bool tick, std::int32_t xi, std::int32_t xq, std::int32_t yi, std::int32_t yq,
              std::int32_t* baseband_xi, std::int32_t* baseband_xq, std::int32_t* baseband_yi,
              std::int32_t* baseband_yq);

/// DAC words of this sample. With a set `tick`, what the tick before left comes into force, and the commands
/// and the increment that this tick computed are left for the next one; carrier_offset is theirs.
void hemi_modulator(bool reset, bool tick, std::int64_t phase, std::int32_t drive, std::int32_t rebalance,
                    std::int32_t quadrature, std::int64_t increment, std::int32_t modulation_phase,
                    std::int32_t modulation_delay, std::int32_t* carrier, std::int32_t* dac_drive,
                    std::int32_t* dac_rebalance, std::int32_t* dac_quadrature, std::int32_t* carrier_offset);

// ---- At each tick

/// Four channels.
void hemi_image_filter(bool reset, std::int32_t xi, std::int32_t xq, std::int32_t yi, std::int32_t yq,
                       std::int32_t* baseband_xi, std::int32_t* baseband_xq, std::int32_t* baseband_yi,
                       std::int32_t* baseband_yq);

/// No state.
void hemi_phase_detector(std::int32_t xi, std::int32_t xq, std::int32_t yi, std::int32_t yq,
                         std::int32_t demodulation_cos, std::int32_t demodulation_sin,
                         std::int64_t* amplitude, std::int32_t* phase_error, std::int32_t* in_phase,
                         std::int32_t* quadrature, bool* saturated);

/// `mode_...` are hls::LoopMode; `start` is the increment that a restart of the phase loop begins with.
void hemi_start_up(bool reset, std::int64_t amplitude, bool locked, bool control,
                   std::int64_t amplitude_threshold, std::int64_t search_amplitude,
                   std::int64_t closing_amplitude, std::int32_t search_ticks, std::int64_t nco_start,
                   std::int64_t search_step, std::int64_t search_span, std::int32_t holdover_ticks,
                   std::int32_t* state, bool* restart, std::int64_t* start, std::int32_t* mode_amplitude,
                   std::int32_t* mode_quadrature, std::int32_t* mode_rebalance);

/// A set `restart` forgets the lock and begins from `start` before the step; so does `reset`, without one.
void hemi_reference_phase_loop(std::uint8_t reset, std::uint8_t restart, std::int64_t start,
                               std::int64_t amplitude, std::int32_t phase_error,
                               std::int32_t loop_proportional, std::int32_t loop_integral,
                               std::int32_t loop_frequency, std::int64_t amplitude_threshold,
                               std::int32_t lock_count, std::int64_t* increment, std::int64_t* integral,
                               std::int32_t* counter, bool* locked, bool* holdover, bool* saturated);

/// One controller each; they differ in the formats of their gains. `mode` is an hls::LoopMode.
void hemi_amplitude_loop(bool reset, std::int32_t mode, std::int32_t error, std::int32_t proportional,
                         std::int32_t integral_gain, std::int32_t start, std::int32_t limit,
                         std::int64_t* integral, std::int32_t* command, bool* saturated);
void hemi_quadrature_loop(bool reset, std::int32_t mode, std::int32_t error, std::int32_t proportional,
                          std::int32_t integral_gain, std::int32_t start, std::int32_t limit,
                          std::int64_t* integral, std::int32_t* command, bool* saturated);
void hemi_rebalance_loop(bool reset, std::int32_t mode, std::int32_t error, std::int32_t proportional,
                         std::int32_t integral_gain, std::int32_t limit, std::int64_t* integral,
                         std::int32_t* command, bool* saturated);

/// `phase` is the nco's after the tick's samples. A set `output` then ends the output interval; without one
/// frequency and sums are 0.
void hemi_frequency_tracker(bool reset, bool output, std::int64_t phase, std::int64_t amplitude,
                            std::int32_t phase_error, std::int64_t* tick_phase, std::int64_t* frequency,
                            std::int64_t* amplitude_sum, std::int64_t* phase_error_sum);

/// `control` chooses the source: the rebalance command, or the secondary in phase. `output` as above.
void hemi_rate_filter(bool reset, bool output, bool control, std::int32_t in_phase, std::int32_t rebalance,
                      std::int32_t rate_gain, std::int64_t* rate_tick, std::int64_t* rate, bool* saturated);

// ---- At each output

/// No state.
void hemi_thermometer(std::int64_t frequency, std::int64_t frequency_reference, std::int32_t thermometer_0,
                      std::int32_t thermometer_1, std::int32_t thermometer_2, std::int32_t thermometer_3,
                      std::int32_t thermometer_4, std::int32_t thermometer_5, std::int32_t* offset,
                      std::int32_t* temperature, bool* out_of_range, bool* saturated);

/// `good`: the frequency may be used.
void hemi_derivative(bool reset, bool good, std::int64_t frequency, std::int64_t frequency_reference,
                     std::int32_t log2_block, std::int32_t slope_shift, std::int32_t slope_gain,
                     std::int32_t* derivative, std::int64_t* slope_sum, bool* valid, bool* saturated);

/// All ten terms and the correction of the rate: no state.
void hemi_bias_model(std::int32_t offset, std::int32_t derivative, std::int64_t rate, std::int32_t bias_0,
                     std::int32_t bias_f, std::int32_t bias_f2, std::int32_t bias_f3, std::int32_t bias_df,
                     std::int32_t bias_df2, std::int32_t bias_df3, std::int32_t bias_f_df,
                     std::int32_t bias_f2_df, std::int32_t bias_f_df2, std::int32_t scale_correction,
                     std::int32_t* bias, std::int64_t* compensated, bool* bias_saturated,
                     bool* compensation_saturated);

/// Closes an output interval in which the bits of `raised` (config::StatusBit) were raised.
void hemi_status(bool reset, std::int32_t raised, std::int64_t* word);

// ---- The whole core

/// One call is, in this order of precedence: `write`, register `address` takes `data` (in force from the next
/// reset on); `reset`; `telemetry`, one telemetry sample (gap: it is not valid); else one sample pair.
/// `record` has the words of config::RecordWord and is new where record_valid is set.
void hemi_core_reference(std::uint8_t write, std::int32_t address, std::int64_t data, std::uint8_t reset,
                         std::uint8_t telemetry, std::int32_t x, std::int32_t y, std::uint8_t gap,
                         std::int64_t frequency, std::int64_t rate, bool* record_valid,
                         std::int64_t record[hemi::config::record_words], std::int32_t* dac_drive,
                         std::int32_t* dac_rebalance, std::int32_t* dac_quadrature);
void hemi_core_wide(std::uint8_t write, std::int32_t address, std::int64_t data, std::uint8_t reset,
                    std::uint8_t telemetry, std::int32_t x, std::int32_t y, std::uint8_t gap,
                    std::int64_t frequency, std::int64_t rate, bool* record_valid,
                    std::int64_t record[hemi::config::record_words], std::int32_t* dac_drive,
                    std::int32_t* dac_rebalance, std::int32_t* dac_quadrature);
}

#endif  // HEMI_HLS_TOPS_TOPS_HPP

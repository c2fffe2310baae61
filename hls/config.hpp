// SPDX-License-Identifier: Apache-2.0
// Every width, rate, register and tap of the core, declared once. The fixed-point kernels, the golden model,
// the RTL's package (generated from this file) and the program all take them from here; docs/chain.md
// explains them.
#ifndef HEMI_HLS_CONFIG_HPP
#define HEMI_HLS_CONFIG_HPP

#include <cstdint>

namespace hemi {
namespace config {

/// Format of one fixed-point word: `width` bits, signed, value = raw * 2^-fraction.
struct Format {
  int width;
  int fraction;
};

// ---- Two instruments: reference (16 bit, 100 kS/s) and wide (18 bit, 250 kS/s)
// -------------------------------
/// Smallest g with base^exponent <= 2^g, for the growth of a cascaded integrator-comb filter.
constexpr int growth_bits(int base, int exponent) {
  std::int64_t power = 1;
  for (int i = 0; i < exponent; ++i) power *= base;
  int bits = 0;
  while ((std::int64_t{1} << bits) < power) ++bits;
  return bits;
}

constexpr int cic_order = 5;          ///< order 3 would leave the image at twice the carrier in the output
constexpr int product_bits = 24;      ///< demodulator products, s0.23
constexpr int ticks_per_output = 25;  ///< loop rate over output rate
constexpr int output_rate_hz = 200;   ///< at the nominal ADC rate

template <int AdcBits, int AdcRateHz, int Decimation>
struct Instrument {
  static constexpr int adc_bits = AdcBits;
  static constexpr int adc_rate_hz = AdcRateHz;
  static constexpr int decimation = Decimation;  ///< ADC samples a loop tick
  static constexpr int samples_per_output = Decimation * ticks_per_output;
  static constexpr int cic_growth = growth_bits(Decimation, cic_order);
  static constexpr int cic_bits = product_bits + cic_growth;
  static_assert(AdcRateHz == 200 * Decimation * ticks_per_output,
                "the output rate is 200 Hz at the nominal ADC rate");
};
using Reference = Instrument<16, 100000, 20>;
using Wide = Instrument<18, 250000, 50>;

// ---- Formats
// ---------------------------------------------------------------------------------------------------
constexpr Format phase = {53, 48};      ///< nco phase, turns modulo 32
constexpr Format increment = {49, 48};  ///< turns a sample
constexpr Format sine = {20, 19};       ///< nco outputs
constexpr Format product = {product_bits, 23};
constexpr Format baseband = {28, 27};           ///< I and Q at the loop rate
constexpr Format cordic = {34, 32};             ///< x and y of the CORDIC; amplitude of one tick
constexpr Format angle = {32, 32};              ///< phase error, turns modulo 1
constexpr Format tick_phase = {37, 32};         ///< phase of one tick, turns modulo 32
constexpr Format total_phase = {46, 32};        ///< unwrapped phase, turns modulo 2^14
constexpr Format frequency = {46, 29};          ///< nominal Hz (Hz * nominal ADC rate / ADC rate)
constexpr Format amplitude_sum = {40, 32};      ///< sum over 50 ticks
constexpr Format phase_error_sum = {38, 32};    ///< sum over 50 ticks, turns
constexpr Format command = {32, 30};            ///< actuator command, fraction of its full scale
constexpr Format command_integral = {44, 40};   ///< integral and proportional part of an actuator loop
constexpr Format command_sum = {38, 30};        ///< command summed over 50 ticks
constexpr Format dac = {16, 15};                ///< DAC word, fraction of full scale
constexpr Format dac_sum = {34, 30};            ///< command times carrier plus the error carried over
constexpr Format increment_operand = {32, 31};  ///< increment, operand of the modulation delay
constexpr Format rate_tick = {37, 26};          ///< deg/h / 625, one tick
constexpr Format rate_accumulator = {47, 26};
constexpr Format rate = {36, 16};         ///< deg/h
constexpr Format offset = {24, 23};       ///< (frequency - reference) / 64 Hz
constexpr Format fine_offset = {32, 25};  ///< frequency - reference, nominal Hz
constexpr Format block_sum = {44, 25};
constexpr Format slope_sum = {51, 25};      ///< numerator of the least-squares slope
constexpr Format slope_word = {30, 29};     ///< the numerator after its programmable shift
constexpr Format derivative = {24, 23};     ///< df/dt over its programmable full scale
constexpr Format temperature = {32, 19};    ///< degC
constexpr Format bias = {32, 13};           ///< deg/h
constexpr Format scale_operand = {32, 11};  ///< deg/h, operand of the scale-factor correction

constexpr int offset_span_hz = 64;     ///< nominal Hz at offset = 1
constexpr int derivative_blocks = 16;  ///< blocks in the window of df/dt
constexpr int max_log2_block = 12;     ///< outputs a block, at most 2^12

// nco table: a quarter wave of 512 lines; a line is (base, delta) and is interpolated with 14 bits.
constexpr int table_index_bits = 9;
constexpr int table_fine_bits = 13;  ///< phase bits behind the index; half a bit is added to each
constexpr int table_scale =
    (1 << 20) - 2;  ///< base of a full sine: the sum can round to 2^19 - 1 and no higher
constexpr int cordic_iterations = 24;

// image_filter: a double zero at 1150 Hz of 5 kHz, where the image at twice the carrier folds to.
constexpr int image_taps[5] = {16, -8, 33, -8, 16};
constexpr int image_shift = 6;

// reference_phase_loop
constexpr int lock_window_log2 = 28;  ///< |phase error| < 2^28 / 2^32 = 1/16 turn counts towards lock
constexpr int steering_window_log2 =
    24;  ///< a change of the error of 2^24 / 2^32 turn a tick (20 Hz) and more steers the frequency
constexpr int lock_penalty = 4;  ///< steps back for a tick outside the window

// start_up: states of the actuator loops
enum LoopState {
  state_open,     ///< control = 0: measuring only, no actuator moves
  state_search,   ///< no signal: drive at its limit, the nco steps through the search span
  state_acquire,  ///< signal, not locked: drive off
  state_rise,     ///< locked: drive pumps the amplitude, rebalance holds the pattern
  state_run       ///< all loops closed
};

// ---- Registers
// ---------------------------------------------------------------------------------------------------
struct Register {
  const char* name;
  Format format;
  const char* unit;
  const char* meaning;
};

enum RegisterIndex {
  reg_nco_start,
  reg_loop_proportional,
  reg_loop_integral,
  reg_loop_frequency,
  reg_amplitude_threshold,
  reg_lock_count,
  reg_demodulation_cos,
  reg_demodulation_sin,
  reg_rate_gain,
  reg_frequency_reference,
  reg_log2_block,
  reg_slope_shift,
  reg_slope_gain,
  reg_thermometer_0,
  reg_thermometer_1,
  reg_thermometer_2,
  reg_thermometer_3,
  reg_thermometer_4,
  reg_thermometer_5,
  reg_bias_0,
  reg_bias_f,
  reg_bias_f2,
  reg_bias_f3,
  reg_bias_df,
  reg_bias_df2,
  reg_bias_df3,
  reg_bias_f_df,
  reg_bias_f2_df,
  reg_bias_f_df2,
  reg_scale_correction,
  reg_calibrated_low,
  reg_calibrated_high,
  reg_control,
  reg_search_amplitude,
  reg_closing_amplitude,
  reg_search_ticks,
  reg_search_step,
  reg_search_span,
  reg_holdover_ticks,
  reg_modulation_phase,
  reg_modulation_delay,
  reg_amplitude_setpoint,
  reg_amplitude_proportional,
  reg_amplitude_integral,
  reg_drive_start,
  reg_drive_limit,
  reg_quadrature_proportional,
  reg_quadrature_integral,
  reg_quadrature_start,
  reg_quadrature_limit,
  reg_rebalance_proportional,
  reg_rebalance_integral,
  reg_rebalance_limit,
  reg_parity,
  register_count
};

constexpr Register registers[register_count] = {
    {"nco_start", increment, "turns/sample", "increment at start"},
    {"loop_proportional", {24, 30}, "turns/sample/turn", "proportional gain of the reference-phase loop"},
    {"loop_integral", {24, 40}, "turns/sample/turn", "integral gain a tick"},
    {"loop_frequency", {24, 30}, "turns/sample/turn", "frequency-steering gain while unlocked"},
    {"amplitude_threshold", cordic, "1", "amplitude below which the loop holds over"},
    {"lock_count", {16, 0}, "ticks", "ticks inside the window until lock"},
    {"demodulation_cos", {24, 22}, "1", "cosine of the demodulation phase"},
    {"demodulation_sin", {24, 22}, "1", "sine of the demodulation phase"},
    {"rate_gain", {24, 13}, "deg/h/625", "rate of a full-scale in-phase secondary, over 625"},
    {"frequency_reference", frequency, "Hz", "frequency at offset 0"},
    {"log2_block", {6, 0}, "1", "log2 of the outputs a block of df/dt, 0..12"},
    {"slope_shift", {7, 0}, "1", "right shift of the slope's numerator, 0..50"},
    {"slope_gain", {24, 23}, "1", "gain behind the shift"},
    {"thermometer_0", temperature, "degC", "coefficient of offset^0"},
    {"thermometer_1", temperature, "degC", "coefficient of offset^1"},
    {"thermometer_2", temperature, "degC", "coefficient of offset^2"},
    {"thermometer_3", temperature, "degC", "coefficient of offset^3"},
    {"thermometer_4", temperature, "degC", "coefficient of offset^4"},
    {"thermometer_5", temperature, "degC", "coefficient of offset^5"},
    {"bias_0", bias, "deg/h", "B0"},
    {"bias_f", bias, "deg/h", "k1, offset"},
    {"bias_f2", bias, "deg/h", "k2, offset^2"},
    {"bias_f3", bias, "deg/h", "k3, offset^3"},
    {"bias_df", bias, "deg/h", "k4, derivative"},
    {"bias_df2", bias, "deg/h", "k5, derivative^2"},
    {"bias_df3", bias, "deg/h", "k6, derivative^3"},
    {"bias_f_df", bias, "deg/h", "k7, offset * derivative"},
    {"bias_f2_df", bias, "deg/h", "k8, offset^2 * derivative"},
    {"bias_f_df2", bias, "deg/h", "k9, offset * derivative^2"},
    {"scale_correction", {20, 23}, "1", "1 / scale factor - 1"},
    {"calibrated_low", offset, "1", "lowest calibrated offset"},
    {"calibrated_high", offset, "1", "highest calibrated offset"},
    {"control", {4, 0}, "1", "0: open loop, actuators at rest; 1: force to rebalance"},
    {"search_amplitude", cordic, "1", "amplitude that ends the search"},
    {"closing_amplitude", cordic, "1", "amplitude from which all loops work as in operation"},
    {"search_ticks", {24, 0}, "ticks", "ticks of search before the nco steps on"},
    {"search_step", increment, "turns/sample", "step of the nco in the search"},
    {"search_span", increment, "turns/sample", "largest offset from nco_start in the search"},
    {"holdover_ticks", {24, 0}, "ticks", "ticks of hold-over before the search starts again"},
    {"modulation_phase", angle, "turns", "phase of the drive's carrier"},
    {"modulation_delay", {24, 18}, "samples", "delay that the carrier is ahead by"},
    {"amplitude_setpoint", cordic, "1", "amplitude to hold"},
    {"amplitude_proportional", {24, 16}, "1", "proportional gain, drive command per amplitude"},
    {"amplitude_integral", {24, 28}, "1", "integral gain a tick"},
    {"drive_start", command, "1", "drive command at the start of the amplitude loop"},
    {"drive_limit", command, "1", "largest drive command"},
    {"quadrature_proportional", {24, 13}, "1", "proportional gain, command per secondary quadrature"},
    {"quadrature_integral", {24, 24}, "1", "integral gain a tick"},
    {"quadrature_start", command, "1", "quadrature command at the start of its loop"},
    {"quadrature_limit", command, "1", "largest quadrature command"},
    {"rebalance_proportional", {24, 13}, "1", "proportional gain, command per secondary in phase"},
    {"rebalance_integral", {24, 20}, "1", "integral gain a tick"},
    {"rebalance_limit", command, "1", "largest rebalance command"},
    {"parity", {54, 0}, "1", "exclusive or of all other registers, sign-extended to 54 bits"},
};

// ---- Record: eleven words at the output rate, in this order
// ------------------------------------------------------
enum RecordWord {
  word_frequency,
  word_temperature,
  word_derivative,
  word_amplitude,
  word_phase_error,
  word_drive,
  word_quadrature,
  word_bias,
  word_rate,
  word_compensated,
  word_status,
  record_words
};

// ---- Status bits: live from bit 0, sticky from bit status_shift
// --------------------------------------------------------
constexpr int status_shift = 24;
constexpr Format status = {2 * status_shift + 1, 0};
enum StatusBit {
  status_unlocked,
  status_holdover,
  status_adc_overload,
  status_secondary_saturated,
  status_loop_saturated,
  status_rate_saturated,
  status_frequency_out_of_range,
  status_thermometer_saturated,
  status_derivative_saturated,
  status_derivative_invalid,
  status_bias_saturated,
  status_compensation_saturated,
  status_out_of_calibrated_range,
  status_sample_gap,
  status_parity_error,
  status_drive_saturated,
  status_quadrature_saturated,
  status_rebalance_saturated,
  status_searching,
  status_starting,
  status_frequency_invalid,
  status_bits
};
constexpr const char* status_names[status_bits] = {"unlocked",
                                                   "holdover",
                                                   "adc_overload",
                                                   "secondary_saturated",
                                                   "loop_saturated",
                                                   "rate_saturated",
                                                   "frequency_out_of_range",
                                                   "thermometer_saturated",
                                                   "derivative_saturated",
                                                   "derivative_invalid",
                                                   "bias_saturated",
                                                   "compensation_saturated",
                                                   "out_of_calibrated_range",
                                                   "sample_gap",
                                                   "parity_error",
                                                   "drive_saturated",
                                                   "quadrature_saturated",
                                                   "rebalance_saturated",
                                                   "searching",
                                                   "starting",
                                                   "frequency_invalid"};

// ---- Taps: the outputs of each block, in the order of the data
// ------------------------------------------------
enum class TapRate { sample, tick, output };
struct Tap {
  const char* block;
  const char* name;
  TapRate rate;
  Format format;
  const char* unit;
};
enum TapIndex {
  tap_phase,
  tap_cos,
  tap_sin,
  tap_product_xi,
  tap_product_xq,
  tap_product_yi,
  tap_product_yq,
  tap_carrier,
  tap_dac_drive,
  tap_dac_rebalance,
  tap_cic_xi,
  tap_cic_xq,
  tap_cic_yi,
  tap_cic_yq,
  tap_baseband_xi,
  tap_baseband_xq,
  tap_baseband_yi,
  tap_baseband_yq,
  tap_amplitude,
  tap_phase_error,
  tap_secondary_in_phase,
  tap_secondary_quadrature,
  tap_state,
  tap_loop_integral,
  tap_loop_increment,
  tap_lock_counter,
  tap_drive_integral,
  tap_drive,
  tap_quadrature_integral,
  tap_quadrature,
  tap_rebalance_integral,
  tap_rebalance,
  tap_carrier_offset,
  tap_dac_quadrature,
  tap_tick_phase,
  tap_rate_tick,
  tap_frequency,
  tap_rate,
  tap_offset,
  tap_temperature,
  tap_slope_sum,
  tap_derivative,
  tap_bias,
  tap_compensated,
  tap_status,
  tap_count
};
constexpr Tap taps[tap_count] = {
    {"nco", "phase", TapRate::sample, phase, "turns"},
    {"nco", "cos", TapRate::sample, sine, "1"},
    {"nco", "sin", TapRate::sample, sine, "1"},
    {"demodulator", "product_xi", TapRate::sample, product, "1"},
    {"demodulator", "product_xq", TapRate::sample, product, "1"},
    {"demodulator", "product_yi", TapRate::sample, product, "1"},
    {"demodulator", "product_yq", TapRate::sample, product, "1"},
    {"modulator", "carrier", TapRate::sample, sine, "1"},
    {"modulator", "dac_drive", TapRate::sample, dac, "full scale"},
    {"modulator", "dac_rebalance", TapRate::sample, dac, "full scale"},
    {"cic", "cic_xi", TapRate::tick, baseband, "1"},
    {"cic", "cic_xq", TapRate::tick, baseband, "1"},
    {"cic", "cic_yi", TapRate::tick, baseband, "1"},
    {"cic", "cic_yq", TapRate::tick, baseband, "1"},
    {"image_filter", "baseband_xi", TapRate::tick, baseband, "1"},
    {"image_filter", "baseband_xq", TapRate::tick, baseband, "1"},
    {"image_filter", "baseband_yi", TapRate::tick, baseband, "1"},
    {"image_filter", "baseband_yq", TapRate::tick, baseband, "1"},
    {"phase_detector", "amplitude", TapRate::tick, cordic, "1"},
    {"phase_detector", "phase_error", TapRate::tick, angle, "turns"},
    {"phase_detector", "secondary_in_phase", TapRate::tick, baseband, "1"},
    {"phase_detector", "secondary_quadrature", TapRate::tick, baseband, "1"},
    {"start_up", "state", TapRate::tick, {4, 0}, "state"},
    {"reference_phase_loop", "integral", TapRate::tick, increment, "turns/sample"},
    {"reference_phase_loop", "increment", TapRate::tick, increment, "turns/sample"},
    {"reference_phase_loop", "lock_counter", TapRate::tick, {16, 0}, "ticks"},
    {"amplitude_loop", "drive_integral", TapRate::tick, command_integral, "full scale"},
    {"amplitude_loop", "drive", TapRate::tick, command, "full scale"},
    {"quadrature_loop", "quadrature_integral", TapRate::tick, command_integral, "full scale"},
    {"quadrature_loop", "quadrature", TapRate::tick, command, "full scale"},
    {"rebalance_loop", "rebalance_integral", TapRate::tick, command_integral, "full scale"},
    {"rebalance_loop", "rebalance", TapRate::tick, command, "full scale"},
    {"modulator", "carrier_offset", TapRate::tick, angle, "turns"},
    {"modulator", "dac_quadrature", TapRate::tick, dac, "full scale"},
    {"frequency_tracker", "tick_phase", TapRate::tick, tick_phase, "turns"},
    {"rate_filter", "rate_tick", TapRate::tick, rate_tick, "deg/h/625"},
    {"frequency_tracker", "frequency", TapRate::output, frequency, "Hz"},
    {"rate_filter", "rate", TapRate::output, rate, "deg/h"},
    {"thermometer", "offset", TapRate::output, offset, "64 Hz"},
    {"thermometer", "temperature", TapRate::output, temperature, "degC"},
    {"derivative", "slope_sum", TapRate::output, slope_sum, "Hz"},
    {"derivative", "derivative", TapRate::output, derivative, "full scale"},
    {"bias_model", "bias", TapRate::output, bias, "deg/h"},
    {"bias_model", "compensated", TapRate::output, rate, "deg/h"},
    {"status", "status", TapRate::output, status, "bits"},
};

}  // namespace config
}  // namespace hemi

#endif  // HEMI_HLS_CONFIG_HPP

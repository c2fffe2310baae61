// SPDX-License-Identifier: Apache-2.0
#include "golden/chain/chain.hpp"

#include <stdexcept>
#include <string>

#include "golden/chain/demodulator.hpp"

namespace hemi::golden {
namespace {

using namespace config;

void check_grid(const RegisterValues& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Format& format = registers[i].format;
    const bool inside = lowest_of(format) <= values[i] && values[i] <= highest_of(format);
    if (!inside || floor_to(values[i], format.fraction) != values[i]) {
      throw std::invalid_argument(std::string("register ") + registers[i].name + ": " +
                                  std::to_string(values[i]) + " is no word of its format");
    }
  }
}

const RegisterValues& checked(Precision precision, const RegisterValues& values) {
  if (precision == Precision::quantised) check_grid(values);
  return values;
}

ReferencePhaseLoop::Settings loop_settings(const RegisterValues& values) {
  return {values[reg_nco_start],      values[reg_loop_proportional],   values[reg_loop_integral],
          values[reg_loop_frequency], values[reg_amplitude_threshold], values[reg_lock_count]};
}

bool closes_loops(const RegisterValues& values) {
  return modulo(values[reg_control], 2.0) != 0.0;
}

StartUp::Settings start_settings(const RegisterValues& values) {
  return {closes_loops(values),          values[reg_amplitude_threshold], values[reg_search_amplitude],
          values[reg_closing_amplitude], values[reg_search_ticks],        values[reg_search_step],
          values[reg_search_span],       values[reg_holdover_ticks]};
}

}  // namespace

InstrumentParameters InstrumentParameters::reference() {
  return {Reference::adc_bits, Reference::adc_rate_hz, Reference::decimation};
}

InstrumentParameters InstrumentParameters::wide() {
  return {Wide::adc_bits, Wide::adc_rate_hz, Wide::decimation};
}

double Chain::IntervalSums::close() {
  const double both = now + before;
  before = now;
  now = 0.0;
  return both;
}

Chain::Chain(Precision precision, const InstrumentParameters& instrument, const RegisterValues& values)
    : arithmetic_(precision),
      instrument_(instrument),
      values_(checked(precision, values)),
      parity_error_(arithmetic_.quantised() && !parity_holds(values)),
      control_(closes_loops(values)),
      nco_(precision, values[reg_nco_start]),
      cic_(precision, instrument.decimation),
      image_filter_(precision),
      start_up_(precision, start_settings(values)),
      loop_(precision, loop_settings(values)),
      actuators_(precision, values),
      modulator_(precision, {values[reg_modulation_phase], values[reg_modulation_delay]}),
      tracker_(precision),
      rate_filter_(precision, values[reg_rate_gain]),
      thermometer_(precision, values),
      derivative_(precision, values),
      bias_model_(precision, values),
      phase_(instrument.decimation),
      cosine_(instrument.decimation),
      sine_(instrument.decimation),
      carrier_(instrument.decimation),
      dac_drive_(Eigen::ArrayXd::Zero(instrument.decimation)),
      dac_rebalance_(Eigen::ArrayXd::Zero(instrument.decimation)) {}

void Chain::samples(const Eigen::Ref<const Eigen::VectorXd>& x_lsb,
                    const Eigen::Ref<const Eigen::VectorXd>& y_lsb, const std::vector<std::uint8_t>* gap,
                    std::vector<ChainRecord>& out) {
  if (x_lsb.size() != y_lsb.size() ||
      (gap != nullptr && static_cast<Eigen::Index>(gap->size()) != x_lsb.size())) {
    throw std::invalid_argument("chain: x, y and gap differ in length");
  }
  Eigen::Index done = 0;
  while (done < x_lsb.size()) {
    const Eigen::Index count = std::min(instrument_.decimation - sample_in_tick_, x_lsb.size() - done);
    if (gap != nullptr) {
      const auto first = gap->begin() + done;
      status_.raise(status_sample_gap,
                    std::any_of(first, first + count, [](std::uint8_t g) { return g != 0; }));
    }
    part_of_tick(x_lsb.segment(done, count), y_lsb.segment(done, count));
    close_part(count, out);
    done += count;
  }
}

DacWords Chain::step(double x_lsb, double y_lsb, bool gap, std::vector<ChainRecord>& out) {
  status_.raise(status_sample_gap, gap);
  part_of_tick(Eigen::Map<const Eigen::VectorXd>(&x_lsb, 1), Eigen::Map<const Eigen::VectorXd>(&y_lsb, 1));
  const DacWords words{dac_drive_[0], dac_rebalance_[0], modulator_.quadrature()};
  close_part(1, out);
  return words;
}

void Chain::close_part(Eigen::Index count, std::vector<ChainRecord>& out) {
  sample_in_tick_ += count;
  if (sample_in_tick_ < instrument_.decimation) return;
  sample_in_tick_ = 0;
  tick();
  if (++tick_in_output_ < ticks_per_output) return;
  tick_in_output_ = 0;
  output(out);
}

void Chain::part_of_tick(const Eigen::Ref<const Eigen::VectorXd>& x_lsb,
                         const Eigen::Ref<const Eigen::VectorXd>& y_lsb) {
  const Eigen::Index count = x_lsb.size();
  const double full_scale = power_of_two(instrument_.adc_bits - 1);
  nco_.run(count, phase_.head(count), cosine_.head(count), sine_.head(count));
  auto products = cic_.samples(sample_in_tick_, count);
  demodulate(arithmetic_, x_lsb.array() / full_scale, y_lsb.array() / full_scale, cosine_.head(count),
             sine_.head(count), products);
  status_.raise(status_adc_overload, std::max(x_lsb.maxCoeff(), y_lsb.maxCoeff()) >= full_scale - 1.0 ||
                                         std::min(x_lsb.minCoeff(), y_lsb.minCoeff()) <= -full_scale);
  // With all commands 0 the words are 0 and no error is carried over: nothing to compute unless somebody
  // wants to see the carrier.
  if (control_ || listener_ != nullptr) {
    modulator_.run(phase_.head(count), carrier_.head(count), dac_drive_.head(count),
                   dac_rebalance_.head(count));
  }
  if (listener_ != nullptr) tap_samples(count, products);
}

void Chain::tap_samples(Eigen::Index count,
                        const Eigen::Ref<const Cic::Products, 0, Eigen::OuterStride<>>& products) {
  for (Eigen::Index i = 0; i < count; ++i) {
    tap(tap_phase, phase_[i]);
    tap(tap_cos, cosine_[i]);
    tap(tap_sin, sine_[i]);
    for (int c = 0; c < channels; ++c) tap(static_cast<TapIndex>(tap_product_xi + c), products(i, c));
    tap(tap_carrier, carrier_[i]);
    tap(tap_dac_drive, dac_drive_[i]);
    tap(tap_dac_rebalance, dac_rebalance_[i]);
  }
}

void Chain::tick() {
  nco_.set_increment(loop_.increment());
  modulator_.engage();
  const Cic::Baseband decimated = cic_.tick();
  const Cic::Baseband baseband = image_filter_.tick(decimated);
  const Polar primary = polar(arithmetic_, baseband[channel_xi], baseband[channel_xq]);
  const Secondary secondary = rotate(arithmetic_, baseband[channel_yi], baseband[channel_yq],
                                     values_[reg_demodulation_cos], values_[reg_demodulation_sin]);
  actuate(primary, secondary);
  const double tick_phase = tracker_.tick(nco_.phase(), primary.phase_error);
  bool rate_clipped = false;
  const double rate =
      rate_filter_.tick(control_ ? actuators_.commands().rebalance : secondary.in_phase, rate_clipped);
  amplitude_.now += primary.amplitude;
  phase_error_.now += primary.phase_error;
  drive_.now += actuators_.commands().drive;
  quadrature_.now += actuators_.commands().quadrature;

  status_.raise(status_secondary_saturated, secondary.clipped);
  status_.raise(status_loop_saturated, loop_.clipped());
  status_.raise(status_unlocked, !loop_.locked());
  status_.raise(status_holdover, loop_.holdover());
  status_.raise(status_rate_saturated, rate_clipped);

  for (int c = 0; c < channels; ++c) tap(static_cast<TapIndex>(tap_cic_xi + c), decimated[c]);
  for (int c = 0; c < channels; ++c) tap(static_cast<TapIndex>(tap_baseband_xi + c), baseband[c]);
  tap(tap_amplitude, primary.amplitude);
  tap(tap_phase_error, primary.phase_error);
  tap(tap_secondary_in_phase, secondary.in_phase);
  tap(tap_secondary_quadrature, secondary.quadrature);
  tap(tap_state, start_up_.state());
  tap(tap_loop_integral, loop_.integral());
  tap(tap_loop_increment, loop_.increment());
  tap(tap_lock_counter, loop_.lock_counter());
  tap_actuators();
  tap(tap_tick_phase, tick_phase);
  tap(tap_rate_tick, rate);
}

void Chain::actuate(const Polar& primary, const Secondary& secondary) {
  start_up_.tick(primary.amplitude, loop_.locked());
  if (start_up_.restart()) loop_.restart(values_[reg_nco_start] + start_up_.search_offset());
  loop_.tick(primary);
  actuators_.tick(start_up_.state(), start_up_.low(), primary.amplitude, secondary);
  modulator_.tick(actuators_.commands(), loop_.increment());

  status_.raise(status_drive_saturated, actuators_.amplitude_loop().saturated());
  status_.raise(status_quadrature_saturated, actuators_.quadrature_loop().saturated());
  status_.raise(status_rebalance_saturated, actuators_.rebalance_loop().saturated());
  status_.raise(status_searching, start_up_.searching());
  status_.raise(status_starting, start_up_.starting());
}

void Chain::tap_actuators() {
  tap(tap_drive_integral, actuators_.amplitude_loop().integral());
  tap(tap_drive, actuators_.commands().drive);
  tap(tap_quadrature_integral, actuators_.quadrature_loop().integral());
  tap(tap_quadrature, actuators_.commands().quadrature);
  tap(tap_rebalance_integral, actuators_.rebalance_loop().integral());
  tap(tap_rebalance, actuators_.commands().rebalance);
  tap(tap_carrier_offset, modulator_.next_offset());
  tap(tap_dac_quadrature, modulator_.next_quadrature());
}

void Chain::output(std::vector<ChainRecord>& out) {
  constexpr int kFirstValid = 2;
  const bool valid = outputs_ >= kFirstValid;
  if (!valid) ++outputs_;
  ChainRecord record{};
  record.words[word_amplitude] = amplitude_.close();
  record.words[word_phase_error] = phase_error_.close();
  record.words[word_drive] = drive_.close();
  record.words[word_quadrature] = quadrature_.close();
  bool rate_clipped = false;
  const double rate_dph = rate_filter_.output(rate_clipped);
  status_.raise(status_rate_saturated, rate_clipped);
  status_.raise(status_frequency_invalid, !valid);
  finish(record, tracker_.output(), rate_dph, valid && loop_.locked(), out);
}

void Chain::telemetry(double frequency_hz, double rate_dph, bool valid, std::vector<ChainRecord>& out) {
  bool clipped = false;
  const auto word = [&](double value, const Format& format) {
    return arithmetic_.saturate(arithmetic_.round(value, format.fraction), format, clipped);
  };
  status_.raise(status_frequency_invalid, !valid);
  finish(ChainRecord{}, word(frequency_hz, frequency), word(rate_dph, rate), valid, out);
}

void Chain::finish(ChainRecord record, double frequency_hz, double rate_dph, bool good,
                   std::vector<ChainRecord>& out) {
  const double difference_hz = frequency_hz - values_[reg_frequency_reference];
  const Thermometer::Output thermal = thermometer_(difference_hz);
  const Derivative::Output slope = derivative_(difference_hz, good);
  const BiasModel::Output drift = bias_model_(thermal.offset, slope.value, rate_dph);

  status_.raise(status_frequency_out_of_range, thermal.out_of_range);
  status_.raise(status_thermometer_saturated, thermal.clipped);
  status_.raise(status_out_of_calibrated_range, thermal.offset < values_[reg_calibrated_low] ||
                                                    thermal.offset > values_[reg_calibrated_high]);
  status_.raise(status_derivative_saturated, slope.clipped);
  status_.raise(status_derivative_invalid, slope.invalid);
  status_.raise(status_bias_saturated, drift.bias_clipped);
  status_.raise(status_compensation_saturated, drift.compensation_clipped);
  status_.raise(status_parity_error, parity_error_);

  record.words[word_frequency] = frequency_hz;
  record.words[word_temperature] = thermal.temperature_c;
  record.words[word_derivative] = slope.value;
  record.words[word_bias] = drift.bias_dph;
  record.words[word_rate] = rate_dph;
  record.words[word_compensated] = drift.compensated_dph;
  record.words[word_status] = status_.output();

  tap(tap_frequency, frequency_hz);
  tap(tap_rate, rate_dph);
  tap(tap_offset, thermal.offset);
  tap(tap_temperature, thermal.temperature_c);
  tap(tap_slope_sum, slope.slope_sum);
  tap(tap_derivative, slope.value);
  tap(tap_bias, drift.bias_dph);
  tap(tap_compensated, drift.compensated_dph);
  tap(tap_status, record.words[word_status]);
  out.push_back(record);
}

}  // namespace hemi::golden

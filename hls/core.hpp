// SPDX-License-Identifier: Apache-2.0
//
// core: the whole chain, one call a sample pair.
//
//   nco -> demodulator -> cic -> image_filter -> phase_detector -> reference_phase_loop (back to the nco)
//       -> start_up, amplitude_loop, quadrature_loop, rebalance_loop -> modulator (back to the DACs)
//       -> frequency_tracker, rate_filter -> thermometer -> derivative -> bias_model -> status -> record
//
// Template parameters: the instrument (config::Reference, config::Wide). `probe(tap, value)` hears the output
// of every block (config::TapIndex); NoProbe costs nothing. docs/chain.md is the contract.
#ifndef HEMI_HLS_CORE_HPP
#define HEMI_HLS_CORE_HPP

#include "hls/actuators.hpp"
#include "hls/bias_model.hpp"
#include "hls/cic.hpp"
#include "hls/demodulator.hpp"
#include "hls/derivative.hpp"
#include "hls/frequency_tracker.hpp"
#include "hls/image_filter.hpp"
#include "hls/rate_filter.hpp"
#include "hls/reference_phase_loop.hpp"
#include "hls/thermometer.hpp"

namespace hemi {
namespace hls {

/// Raw words of one output, in the order of config::RecordWord.
struct Record {
  std::int64_t word[config::record_words];
};

template <class Instrument>
class Core {
 public:
  using Adc = typename Demodulator<Instrument>::Adc;

  /// Loads the registers (raw words) and starts from sample 0.
  void reset(const std::int64_t (&image)[config::register_count]) {
    registers_.load(image);
    nco_.reset();
    for (int i = 0; i < channels; ++i) {
      cic_[i].reset();
      image_filter_[i].reset();
    }
    loop_.reset(registers_.nco_start);
    increment_ = registers_.nco_start;
    actuators_.reset();
    tracker_.reset();
    rate_filter_.reset();
    derivative_.reset();
    status_.reset();
    sample_count_ = tick_count_ = output_count_ = 0;
  }

  /// One sample pair, raw ADC words; true when a record has become complete.
  template <class Probe>
  bool sample(std::int32_t x, std::int32_t y, bool gap, Record& record, Probe& probe) {
    front_end(x, y, gap, probe);
    if (++sample_count_ < Instrument::decimation) return false;
    sample_count_ = 0;
    tick(probe);
    if (++tick_count_ < config::ticks_per_output) return false;
    tick_count_ = 0;
    output(record, probe);
    return true;
  }

  /// One telemetry sample, raw words, in behind the tracker; completes a record each time.
  template <class Probe>
  void telemetry(std::int64_t frequency, std::int64_t rate, bool valid, Record& record, Probe& probe) {
    record.word[config::word_amplitude] = 0;
    record.word[config::word_phase_error] = 0;
    record.word[config::word_drive] = 0;
    record.word[config::word_quadrature] = 0;
    finish(from_raw<Frequency>(frequency), from_raw<Rate>(rate), valid, valid, record, probe);
  }

  /// DAC words of the last sample, raw (config::dac).
  std::int32_t dac_drive() const { return static_cast<std::int32_t>(raw(actuators_.drive_word())); }
  std::int32_t dac_rebalance() const { return static_cast<std::int32_t>(raw(actuators_.rebalance_word())); }
  std::int32_t dac_quadrature() const { return static_cast<std::int32_t>(raw(actuators_.quadrature_word())); }

 private:
  template <class Probe>
  void front_end(std::int32_t x, std::int32_t y, bool gap, Probe& probe) {
    const SinCos nco = nco_.output();
    probe(config::tap_phase, nco_.phase());
    probe(config::tap_cos, nco.cosine);
    probe(config::tap_sin, nco.sine);
    Product products[channels];
    Demodulator<Instrument>::mix(from_raw<Adc>(x), from_raw<Adc>(y), nco, products);
    for (int i = 0; i < channels; ++i) {
      probe(static_cast<config::TapIndex>(config::tap_product_xi + i), products[i]);
      cic_[i].integrate(products[i]);
    }
    actuators_.sample(nco_.phase(), probe);
    nco_.advance(increment_);
    constexpr std::int32_t rail = std::int32_t{1} << (Instrument::adc_bits - 1);
    status_.raise(config::status_adc_overload, x == rail - 1 || x == -rail || y == rail - 1 || y == -rail);
    status_.raise(config::status_sample_gap, gap);
  }

  template <class Probe>
  void tick(Probe& probe) {
    increment_ = loop_.increment();
    actuators_.take_over();
    Baseband decimated[channels];
    Baseband baseband[channels];
    for (int i = 0; i < channels; ++i) {
      decimated[i] = cic_[i].decimate();
      probe(static_cast<config::TapIndex>(config::tap_cic_xi + i), decimated[i]);
    }
    for (int i = 0; i < channels; ++i) {
      baseband[i] = image_filter_[i].step(decimated[i]);
      probe(static_cast<config::TapIndex>(config::tap_baseband_xi + i), baseband[i]);
    }
    bool secondary_saturated = false, loop_saturated = false, rate_saturated = false;
    const Polar polar = PhaseDetector::vectoring(baseband[0], baseband[1]);
    const Secondary secondary = PhaseDetector::rotate(baseband[2], baseband[3], registers_.demodulation_cos,
                                                      registers_.demodulation_sin, secondary_saturated);
    probe(config::tap_amplitude, polar.amplitude);
    probe(config::tap_phase_error, polar.phase_error);
    probe(config::tap_secondary_in_phase, secondary.in_phase);
    probe(config::tap_secondary_quadrature, secondary.quadrature);
    if (actuators_.start_up(polar, loop_.locked(), registers_, probe))
      loop_.restart(actuators_.start(registers_));
    loop_.step(polar, registers_, loop_saturated);
    probe(config::tap_loop_integral, loop_.integral());
    probe(config::tap_loop_increment, loop_.increment());
    probe(config::tap_lock_counter, from_raw<Fixed<16, 16>>(loop_.counter()));
    actuators_.loops(polar, secondary, loop_.increment(), registers_, status_, probe);
    probe(config::tap_tick_phase, tracker_.step(nco_.phase(), polar));
    probe(config::tap_rate_tick,
          registers_.control == 0
              ? rate_filter_.step(secondary.in_phase, registers_.rate_gain, rate_saturated)
              : rate_filter_.step(actuators_.rebalance(), registers_.rate_gain, rate_saturated));
    status_.raise(config::status_secondary_saturated, secondary_saturated);
    status_.raise(config::status_loop_saturated, loop_saturated);
    status_.raise(config::status_rate_saturated, rate_saturated);
    status_.raise(config::status_unlocked, !loop_.locked());
    status_.raise(config::status_holdover, loop_.holdover());
  }

  template <class Probe>
  void output(Record& record, Probe& probe) {
    const Frequency frequency = tracker_.frequency();
    probe(config::tap_frequency, frequency);
    bool rate_saturated = false;
    const Rate rate = rate_filter_.rate(rate_saturated);
    probe(config::tap_rate, rate);
    status_.raise(config::status_rate_saturated, rate_saturated);
    record.word[config::word_amplitude] = raw(tracker_.amplitude());
    record.word[config::word_phase_error] = raw(tracker_.phase_error());
    record.word[config::word_drive] = raw(actuators_.drive_sum());
    record.word[config::word_quadrature] = raw(actuators_.quadrature_sum());
    // The first output has no predecessor and the second holds the filters' start.
    const bool valid = output_count_ >= 2;
    if (!valid) ++output_count_;
    finish(frequency, rate, valid, valid && loop_.locked(), record, probe);
  }

  template <class Probe>
  void finish(const Frequency& frequency, const Rate& rate, bool valid, bool good, Record& record,
              Probe& probe) {
    const Registers& r = registers_;
    bool out_of_range = false, hot = false, steep = false, bias_saturated = false,
         compensation_saturated = false;
    const Thermometer::Difference difference = Thermometer::difference(frequency, r);
    const Offset offset = Thermometer::offset(difference, out_of_range);
    const Temperature temperature = Thermometer::temperature(offset, r, hot);
    const Derivative derivative = derivative_.step(difference, good, r, steep);
    const Bias bias = BiasModel::bias(offset, derivative, r, bias_saturated);
    const Rate compensated = BiasModel::compensate(rate, bias, r, compensation_saturated);
    status_.raise(config::status_frequency_out_of_range, out_of_range);
    status_.raise(config::status_thermometer_saturated, hot);
    status_.raise(config::status_derivative_saturated, steep);
    status_.raise(config::status_derivative_invalid, !derivative_.valid());
    status_.raise(config::status_bias_saturated, bias_saturated);
    status_.raise(config::status_compensation_saturated, compensation_saturated);
    status_.raise(config::status_out_of_calibrated_range,
                  offset < r.calibrated_low || offset > r.calibrated_high);
    status_.raise(config::status_parity_error, r.parity_error);
    status_.raise(config::status_frequency_invalid, !valid);
    const std::int64_t status = status_.close();
    probe(config::tap_offset, offset);
    probe(config::tap_temperature, temperature);
    probe(config::tap_slope_sum, derivative_.slope_sum());
    probe(config::tap_derivative, derivative);
    probe(config::tap_bias, bias);
    probe(config::tap_compensated, compensated);
    probe(config::tap_status, from_raw<Word<config::status>>(status));
    record.word[config::word_frequency] = raw(frequency);
    record.word[config::word_temperature] = raw(temperature);
    record.word[config::word_derivative] = raw(derivative);
    record.word[config::word_bias] = raw(bias);
    record.word[config::word_rate] = raw(rate);
    record.word[config::word_compensated] = raw(compensated);
    record.word[config::word_status] = status;
  }

  Registers registers_;
  Nco nco_;
  Cic<Instrument> cic_[channels];
  ImageFilter image_filter_[channels];
  ReferencePhaseLoop loop_;
  Actuators actuators_;
  FrequencyTracker tracker_;
  RateFilter rate_filter_;
  DerivativeFilter derivative_;
  Status status_;
  Increment increment_;
  std::int32_t sample_count_ = 0;
  std::int32_t tick_count_ = 0;
  std::int32_t output_count_ = 0;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_CORE_HPP

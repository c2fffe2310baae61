// SPDX-License-Identifier: Apache-2.0
#include "cli/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cli/recording/error.hpp"
#include "cli/register_check.hpp"
#include "golden/calibration/inverse_polynomial.hpp"
#include "golden/calibration/linear_fit.hpp"

namespace hemi::cli {
namespace {

using recording::InputError;
using recording::InstrumentModel;

// Range in which a thermometer is fitted when the model does not say `calibrated_degc`.
constexpr double default_low_degc = -40.0;
constexpr double default_high_degc = 85.0;
constexpr double default_window_s = 20.0;

// The open-loop rate of the nominal resonator: in-phase secondary over primary = kappa tau W.
constexpr double nominal_kappa = 0.554;
constexpr double nominal_tau_s = 719.0;

double polynomial(const std::vector<double>& coefficients, double x) {
  double y = 0.0;
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) y = y * x + *c;
  return y;
}

/// Closed loop -3 dB at 10 Hz with damping 1: wn = 2 pi 10 / sqrt(3 + sqrt(10)), kp = 2 wn, ki = wn^2.
void set_loop(Setup& setup) {
  const Sampling s = sampling(setup.wide);
  const double wn = 2.0 * std::numbers::pi * 10.0 / std::sqrt(3.0 + std::sqrt(10.0));
  setup.values[config::reg_loop_proportional] = 2.0 * wn / s.adc_rate_hz;
  setup.values[config::reg_loop_integral] = wn * wn / (s.adc_rate_hz * s.adc_rate_hz / s.decimation);
  // A 32nd of the frequency error a tick: slow against the six ticks of delay, fast against the loop.
  setup.values[config::reg_loop_frequency] = 1.0 / (32.0 * s.decimation);
  setup.values[config::reg_amplitude_threshold] = 1e-3;
  setup.values[config::reg_lock_count] = 125.0;
  setup.values[config::reg_demodulation_cos] = 1.0;
  const double dph_per_ratio = 1.0 / (nominal_kappa * nominal_tau_s) * 180.0 / std::numbers::pi * 3600.0;
  const double gain = 0.5 * std::pow(s.decimation, config::cic_order) /
                      std::ldexp(1.0, config::growth_bits(s.decimation, config::cic_order)) * 49.0 / 64.0;
  setup.values[config::reg_rate_gain] = dph_per_ratio / (nominal_amplitude * gain) / 625.0;
}

/// slope_shift and slope_gain for blocks of M outputs: derivative = slope / full scale (docs/chain.md).
void set_derivative(Setup& setup, std::optional<double> window_s) {
  const auto window_of = [&](int log2_block) {
    return std::ldexp(config::derivative_blocks * setup.output_period_s, log2_block);
  };
  const auto gain_of = [&](int log2_block) {
    const double full_scale = derivative_full_scale_hz_per_s * setup.rate_ratio;
    return std::ldexp(6.0 / (4080.0 * setup.output_period_s * full_scale),
                      config::slope_word.fraction - config::slope_sum.fraction - 2 * log2_block);
  };
  // A window so short that one step of the slope's sum passes full scale needs a gain above the register's.
  int shortest = 0;
  while (shortest < config::max_log2_block && gain_of(shortest) >= 1.0) ++shortest;
  const double wanted_s = window_s.value_or(default_window_s);
  // "About": the nearest of the windows that there are, by ratio.
  constexpr double half_step = std::numbers::sqrt2;
  if (window_s && !(wanted_s * half_step >= window_of(shortest) &&
                    wanted_s <= window_of(config::max_log2_block) * half_step)) {
    throw InputError(
        {}, fmt::format("no window of df/dt lasts about {} s", wanted_s),
        fmt::format("ask for a --window of {:.4g} s to {:.6g} s at outputs every {:.4g} s",
                    window_of(shortest), window_of(config::max_log2_block), setup.output_period_s));
  }
  const int log2_block = static_cast<int>(std::clamp(std::lround(std::log2(wanted_s / window_of(0))),
                                                     long{shortest}, long{config::max_log2_block}));
  const int shift = std::clamp(-std::ilogb(gain_of(log2_block)) - 1, 0, 50);
  setup.values[config::reg_log2_block] = log2_block;
  setup.values[config::reg_slope_shift] = shift;
  setup.values[config::reg_slope_gain] = std::ldexp(gain_of(log2_block), shift);
  setup.derivative_window_s = window_of(log2_block);
}

/// The inverse polynomial of the highest order whose coefficients fit their registers: over a narrow range of
/// frequency those of high order grow out of them.
calibration::InversePolynomial fit_inverse_that_fits(const calibration::FrequencyPolynomial& frequency,
                                                     double reference_hz, double span_hz) {
  const double limit = std::ldexp(1.0, config::temperature.width - 1 - config::temperature.fraction);
  for (Eigen::Index order = calibration::kMaxInverseOrder;; --order) {
    try {
      auto inverse = calibration::fit_inverse(frequency, reference_hz, order, span_hz);
      if (order == 1 || inverse.coefficients_degc.cwiseAbs().maxCoeff() < limit) return inverse;
    } catch (const calibration::RankDeficiencyError&) {
      // Too narrow a range, seen from the reference, for powers this high.
      if (order == 1) throw;
    }
  }
}

/// The core sees +-64 nominal Hz about its reference: some of f(T) must lie there.
void check_span(const InstrumentModel& model, const calibration::FrequencyPolynomial& frequency,
                double reference_hz, double span_hz) {
  const double ends_hz[] = {frequency.frequency_hz(frequency.min_degc()),
                            frequency.frequency_hz(frequency.max_degc())};
  const double lowest_hz = std::min(ends_hz[0], ends_hz[1]), highest_hz = std::max(ends_hz[0], ends_hz[1]);
  if (!std::isfinite(lowest_hz) || !std::isfinite(highest_hz)) {
    throw InputError(
        {model.path, 0, 0, "frequency.coefficients_hz"},
        fmt::format("f(T) is not finite from {:g} to {:g} degC", frequency.min_degc(), frequency.max_degc()),
        "check the coefficients and calibrated_degc");
  }
  if (reference_hz + span_hz > lowest_hz && reference_hz - span_hz < highest_hz) return;
  throw InputError({model.path, 0, 0, model.bias ? "bias.reference_hz" : "frequency"},
                   fmt::format("{:g} Hz, where the core's range of +-{:g} Hz has its middle, is far from "
                               "f(T), which runs from {:g} to {:g} Hz",
                               reference_hz, span_hz, lowest_hz, highest_hz),
                   "expand the drift model about a frequency of f(T)");
}

/// Thermometer and calibrated range from f(T); the offset is in units of 64 nominal Hz around the reference.
void set_thermometer(Setup& setup, const InstrumentModel& model, double reference_hz) {
  double low = default_low_degc, high = default_high_degc;
  const auto& document = model.document;
  if (document.contains("frequency") && document["frequency"].contains("calibrated_degc")) {
    const auto& range = document["frequency"]["calibrated_degc"];
    if (!range.is_array() || range.size() != 2 || !range[0].is_number() || !range[1].is_number() ||
        !(range[0] < range[1]) || range[0] < -273.15 || range[1] > 1000.0)
      throw InputError({model.path, 0, 0, "frequency.calibrated_degc"}, "is no range",
                       "write it as [lowest, highest] in degC");
    low = range[0];
    high = range[1];
  }
  const double span_hz = config::offset_span_hz / setup.rate_ratio;
  const auto& c = model.frequency->coefficients_hz;
  if (c.size() < 2)
    throw InputError({model.path, 0, 0, "frequency.coefficients_hz"}, "holds no slope",
                     "give at least two coefficients");
  const calibration::FrequencyPolynomial frequency(
      Eigen::Map<const Eigen::VectorXd>(c.data(), static_cast<Eigen::Index>(c.size())),
      model.frequency->reference_degc, low, high);
  if (!frequency.monotone()) {
    throw InputError(
        {model.path, 0, 0, "frequency"},
        fmt::format("f(T) turns round between {} and {} degC, so no frequency names one temperature", low,
                    high),
        "narrow frequency.calibrated_degc");
  }
  check_span(model, frequency, reference_hz, span_hz);
  const auto inverse = fit_inverse_that_fits(frequency, reference_hz, span_hz);
  for (Eigen::Index i = 0; i < inverse.coefficients_degc.size(); ++i) {
    setup.values[static_cast<std::size_t>(config::reg_thermometer_0 + i)] = inverse.coefficients_degc[i];
  }
  setup.thermometer_error_degc = inverse.max_error_degc;
  setup.has_thermometer = true;
  auto offset_at = [&](double degc) {
    const double f = polynomial(model.frequency->coefficients_hz, degc - model.frequency->reference_degc);
    return std::clamp((f - reference_hz) / span_hz, -1.0, 1.0 - std::ldexp(1.0, -config::offset.fraction));
  };
  setup.values[config::reg_calibrated_low] = offset_at(low);
  setup.values[config::reg_calibrated_high] = offset_at(high);
}

/// Eq. (21) from Hz and Hz/s to the core's offset and derivative.
void set_bias(Setup& setup, const InstrumentModel& model) {
  constexpr int f_power[10] = {0, 1, 2, 3, 0, 0, 0, 1, 2, 1};
  constexpr int df_power[10] = {0, 0, 0, 0, 1, 2, 3, 1, 1, 2};
  const double span_hz = config::offset_span_hz / setup.rate_ratio;
  for (int i = 0; i < 10; ++i) {
    setup.values[config::reg_bias_0 + i] = model.bias->terms_dph[i] * std::pow(span_hz, f_power[i]) *
                                           std::pow(derivative_full_scale_hz_per_s, df_power[i]);
  }
}

void set_compensation(Setup& setup, const InstrumentModel& model) {
  const double reference_hz =
      model.bias        ? model.bias->reference_hz
      : model.frequency ? polynomial(model.frequency->coefficients_hz, 20.0 - model.frequency->reference_degc)
                        : 0.0;
  setup.values[config::reg_frequency_reference] = reference_hz * setup.rate_ratio;
  if (model.frequency) set_thermometer(setup, model, reference_hz);
  if (model.bias) set_bias(setup, model);
  setup.values[config::reg_scale_correction] = 1.0 / model.scale_factor - 1.0;
}

/// Without f(T) every offset counts as calibrated.
void set_open_range(Setup& setup) {
  setup.values[config::reg_calibrated_low] = -1.0;
  setup.values[config::reg_calibrated_high] = 1.0 - std::ldexp(1.0, -config::offset.fraction);
}

}  // namespace

Sampling sampling(bool wide) {
  if (wide) return {config::Wide::adc_bits, double{config::Wide::adc_rate_hz}, config::Wide::decimation};
  return {config::Reference::adc_bits, double{config::Reference::adc_rate_hz}, config::Reference::decimation};
}

Setup capture_setup(const recording::RawCapture& capture, const InstrumentModel* model,
                    std::optional<double> start_hz, std::optional<double> window_s) {
  Setup setup;
  const int bits = std::ilogb(capture.full_scale_lsb) + 1;
  setup.wide = bits > config::Reference::adc_bits;
  if (capture.full_scale_lsb != std::ldexp(1.0, bits - 1) || bits > config::Wide::adc_bits || bits < 8) {
    throw InputError(
        {capture.path, 0, 0, "adc_x"},
        fmt::format("full scale {} LSB is not that of a core of 8 to {} bits", capture.full_scale_lsb,
                    int{config::Wide::adc_bits}),
        "state full_scale_lsb (32768 for 16 bits, 131072 for 18), or scale the samples to 18 bits");
  }
  const Sampling s = sampling(setup.wide);
  setup.rate_ratio = s.adc_rate_hz / capture.sample_rate_hz;
  setup.output_period_s = s.decimation * config::ticks_per_output / capture.sample_rate_hz;
  if (!start_hz && model != nullptr && model->frequency) {
    start_hz = polynomial(model->frequency->coefficients_hz, 20.0 - model->frequency->reference_degc);
  }
  if (!start_hz) {
    throw InputError({capture.path}, "where the resonator rings is not known",
                     "give --frequency HZ (within a few Hz), or a --model with its frequency polynomial");
  }
  // The tracker counts up to 16 turns a tick; the demodulator's image filter wants a few turns of 2f a tick.
  // The frequency word ends at 65536 nominal Hz, which is less than 0.3 of the wide instrument's rate.
  const double turns = *start_hz / capture.sample_rate_hz;
  const double word_end_hz =
      std::ldexp(1.0, config::frequency.width - 1 - config::frequency.fraction) - config::offset_span_hz;
  const double most_turns = std::min(0.3, std::floor(100.0 * word_end_hz / s.adc_rate_hz) / 100.0);
  if (!(turns >= 0.005 && turns <= most_turns)) {
    throw InputError(
        {capture.path},
        fmt::format("{} Hz at {} samples/s is {:.4g} of the ADC rate; the chain takes 0.005 to {}", *start_hz,
                    capture.sample_rate_hz, turns, most_turns),
        fmt::format("capture at {:.1f} to 200 times the resonator's frequency; state a wrong rate with "
                    "--adc-rate",
                    std::ceil(10.0 / most_turns) / 10.0));
  }
  set_loop(setup);
  set_derivative(setup, window_s);
  setup.values[config::reg_nco_start] = turns;
  set_open_range(setup);
  if (model != nullptr) set_compensation(setup, *model);
  if (model == nullptr || (!model->bias && !model->frequency))
    setup.values[config::reg_frequency_reference] = *start_hz * setup.rate_ratio;
  check_registers(setup, model);
  return setup;
}

Setup telemetry_setup(double sample_rate_hz, const InstrumentModel& model, std::optional<double> window_s) {
  Setup setup;
  setup.output_period_s = 1.0 / sample_rate_hz;
  if (!model.frequency) {
    throw InputError({model.path, 0, 0, "frequency"}, "is missing", "calibrate f(T) first: hemi calibrate");
  }
  set_derivative(setup, window_s);
  set_compensation(setup, model);
  check_registers(setup, &model);
  return setup;
}

}  // namespace hemi::cli

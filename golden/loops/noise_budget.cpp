// SPDX-License-Identifier: Apache-2.0
#include "golden/loops/noise_budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "golden/physics/converters.hpp"

namespace hemi::loops {
namespace {

using namespace config;
constexpr double kPi = std::numbers::pi;

double squared(double x) {
  return x * x;
}

std::vector<double> convolved(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> c(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  return c;
}

/// Baseband word's response to the ADC samples without their carrier.
std::vector<double> front_end_response(int decimation) {
  std::vector<double> h{std::ldexp(table_scale, -20 - image_shift - growth_bits(decimation, cic_order))};
  const auto r = static_cast<std::size_t>(decimation);
  for (int i = 0; i < cic_order; ++i) h = convolved(h, std::vector<double>(r, 1.0));
  std::vector<double> image(4 * r + 1);
  for (std::size_t i = 0; i < 5; ++i) image[i * r] = image_taps[i];
  return convolved(h, image);
}

/// Sums of h[j] h[j + m R] for m = 0, 1, ...: what white noise becomes at the tick rate, aliases included.
std::vector<double> tick_correlation(const std::vector<double>& h, int decimation) {
  std::vector<double> correlation;
  for (std::size_t shift = 0; shift < h.size(); shift += static_cast<std::size_t>(decimation)) {
    double sum = 0.0;
    for (std::size_t j = 0; j + shift < h.size(); ++j) sum += h[j] * h[j + shift];
    correlation.push_back(sum);
  }
  return correlation;
}

/// Sum of `weight` times sin^4(pi f tau), term by term, over 0 .. end_hz. Up to 100/tau every oscillation is
/// resolved; from there on sin^4 counts by its mean 3/8, and what that leaves out falls with the derivative
/// of the rest over (2 pi tau)^2 as both ends are whole numbers of half periods.
template <class Weighted>
NoiseParts allan_integral(const Weighted& weighted, double tau_s, double end_hz) {
  NoiseParts sum;
  const double resolved_hz = 100.0 / tau_s;
  double from_hz = 0.0;
  while (from_hz < end_hz) {
    const bool resolved = from_hz < resolved_hz * (1.0 - 1e-9);
    const double step_hz = resolved ? 0.5 / tau_s : 0.25 * from_hz;
    const double to_hz = std::min({from_hz + std::min(step_hz, 5.0), end_hz,
                                   resolved ? std::max(resolved_hz, from_hz + 1e-12) : end_hz});
    const double middle = 0.5 * (from_hz + to_hz), half = 0.5 * (to_hz - from_hz);
    const auto add = [&](double f, double weight) {
      const NoiseParts s = weighted(f);
      const double w = weight * half * (resolved ? squared(squared(std::sin(kPi * f * tau_s))) : 0.375);
      sum.pickoff += w * s.pickoff;
      sum.adc += w * s.adc;
      sum.force += w * s.force;
      sum.dac += w * s.dac;
      sum.oscillator += w * s.oscillator;
    };
    using Rule = boost::math::quadrature::gauss<double, 10>;
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      add(middle - half * Rule::abscissa()[i], Rule::weights()[i]);
      add(middle + half * Rule::abscissa()[i], Rule::weights()[i]);
    }
    from_hz = to_hz;
  }
  return sum;
}

NoiseParts times(const NoiseParts& p, double factor) {
  return {p.pickoff * factor, p.adc * factor, p.force * factor, p.dac * factor, p.oscillator * factor};
}

}  // namespace

NoiseBudget::NoiseBudget(const physics::Instrument& instrument, const CoreSampling& sampling, int adc_bits,
                         const ControlWishes& wishes)
    : design_(design_control(instrument, sampling, wishes)),
      tick_rate_hz_(sampling.adc_rate_hz / sampling.decimation),
      adc_rate_hz_(sampling.adc_rate_hz),
      decimation_(sampling.decimation),
      setpoint_(wishes.amplitude_setpoint),
      word_correlation_(tick_correlation(front_end_response(sampling.decimation), sampling.decimation)) {
  if (adc_bits < 16) throw std::invalid_argument("noise budget: an ADC has 16 bits or more");
  const physics::Parameters at20 = instrument.at(20.0);
  const double carrier_hz = at20.omega_rad_s / (2.0 * kPi);
  const double half_turn = kPi * carrier_hz / adc_rate_hz_;
  // The same volts a root hertz at every rate.
  pickoff_variance_ = squared(std::ldexp(instrument.pickoff_noise_lsb, -15)) * adc_rate_hz_ /
                      physics::AdcConfiguration::reference().rate_hz;
  adc_variance_ = squared(std::ldexp(1.0, 1 - adc_bits)) / 12.0;
  rate_of_command_dph_ = instrument.rebalance_full_scale_dps * 3600.0 * design_.hold_gain;
  // Of a density S about the carrier each component has 2 S.
  const double rounding = squared(std::ldexp(1.0, -dac.fraction)) / 12.0 / (0.5 * adc_rate_hz_);
  const double command_density = 2.0 * rounding * 4.0 * squared(std::sin(half_turn));
  force_dph2_hz_ = squared(instrument.force_noise_dph_rthz);
  dac_dph2_hz_ = command_density * squared(rate_of_command_dph_);
  const double turns_a_second = 1.0 / (2.0 * kPi * setpoint_);
  force_hz2_hz_ = squared(instrument.kappa * instrument.force_noise_dph_rthz * physics::kRadPerSecondPerDph *
                          turns_a_second);
  dac_hz2_hz_ = command_density * squared(at20.drive_per_s * design_.hold_gain * turns_a_second);
  oscillator_hz2_hz_ = squared(carrier_hz * instrument.oscillator_noise_rthz);
}

double NoiseBudget::record_rate_hz() const {
  return tick_rate_hz_ / ticks_per_output;
}

double NoiseBudget::word_density(double frequency_hz) const {
  const double x = 2.0 * kPi * frequency_hz / tick_rate_hz_;
  double sum = word_correlation_[0];
  for (std::size_t m = 1; m < word_correlation_.size(); ++m)
    sum += 2.0 * word_correlation_[m] * std::cos(x * static_cast<double>(m));
  // Half of the samples' variance is in phase with the carrier. The cosines cancel where the image filter is
  // 0.
  return std::max(sum, 0.0) * 0.5 * 2.0 / tick_rate_hz_;
}

double NoiseBudget::front_end(double frequency_hz) const {
  const double x = kPi * frequency_hz / adc_rate_hz_;
  const double mean = std::sin(decimation_ * x) / (decimation_ * std::sin(x));
  double image = image_taps[2], sum = image_taps[2];
  for (int i = 0; i < 2; ++i) {
    image += 2.0 * image_taps[i] * std::cos(2.0 * (2 - i) * decimation_ * x);
    sum += 2.0 * image_taps[i];
  }
  return std::pow(mean, cic_order) * image / sum;
}

NoiseParts NoiseBudget::rate_density(double frequency_hz) const {
  const Loop& loop = design_.rebalance;
  const auto delay = std::polar(1.0, -2.0 * kPi * frequency_hz / tick_rate_hz_);
  const std::complex<double> controller = loop.gains.proportional + loop.gains.integral / (1.0 - delay);
  const std::complex<double> open = loop.open(frequency_hz);
  const double of_word =
      std::norm(controller / (1.0 + open)) * squared(rate_of_command_dph_) * word_density(frequency_hz);
  const double of_rate = std::norm(open / (1.0 + open));
  return {of_word * pickoff_variance_, of_word * adc_variance_, of_rate * force_dph2_hz_,
          of_rate * dac_dph2_hz_, 0.0};
}

NoiseParts NoiseBudget::phase_density(double frequency_hz) const {
  const std::complex<double> open = design_.reference_phase.open(frequency_hz);
  const double f = front_end(frequency_hz);
  // The tracker's time for the nco and the detector's differ by 1.5 samples.
  const auto late = std::polar(1.0, 2.0 * kPi * frequency_hz * 1.5 / adc_rate_hz_);
  const double followed = std::norm((1.0 + open * late / f) / (1.0 + open));
  const double of_word =
      followed * word_density(frequency_hz) / squared(2.0 * kPi * setpoint_ * design_.baseband_word);
  const double of_frequency = followed * squared(f / (2.0 * kPi * frequency_hz));
  return {of_word * pickoff_variance_, of_word * adc_variance_, of_frequency * force_hz2_hz_,
          of_frequency * dac_hz2_hz_, of_frequency * oscillator_hz2_hz_};
}

// Both filters have sin(25 pi f / ticks) = sin(pi f / records) in common with the Allan filter's denominator,
//   |H_rate|^2 = (s / (25 t))^4,  |H_frequency|^2 = (16 s^2 / t)^2 Hz^2/turn^2,  |A|^2 = 2 sin^4(pi f tau) /
//   (m s)^2,  s = sin(pi f / records), t = sin(pi f / ticks),
// so that nothing is divided by s.
NoiseParts NoiseBudget::rate_allan_variance(long averaged) const {
  const auto weighted = [this](double f) {
    const double s = std::sin(kPi * f / record_rate_hz()), t = std::sin(kPi * f / tick_rate_hz_);
    return times(rate_density(f), squared(s) / squared(squared(ticks_per_output * t)));
  };
  const double tau_s = static_cast<double>(averaged) / record_rate_hz();
  return times(allan_integral(weighted, tau_s, 0.5 * tick_rate_hz_),
               2.0 / squared(static_cast<double>(averaged)));
}

NoiseParts NoiseBudget::frequency_allan_variance(long averaged) const {
  // One turn of the triangular sum in nominal Hz, whatever the ADC's rate.
  const double hz_per_turn = record_rate_hz() / ticks_per_output;
  const auto weighted = [this](double f) {
    const double s = std::sin(kPi * f / record_rate_hz()), t = std::sin(kPi * f / tick_rate_hz_);
    return times(phase_density(f), squared(2.0 * s / t));
  };
  const double tau_s = static_cast<double>(averaged) / record_rate_hz();
  return times(allan_integral(weighted, tau_s, 0.5 * tick_rate_hz_),
               2.0 * squared(hz_per_turn / static_cast<double>(averaged)));
}

long NoiseBudget::whole_records(double tau_s) const {
  const double records = tau_s * record_rate_hz();
  if (!(records > 0.5) || std::abs(records - std::round(records)) > 1e-6 * records)
    throw std::invalid_argument(
        fmt::format("{} s is no whole number of records of {} s", tau_s, 1.0 / record_rate_hz()));
  return std::lround(records);
}

double NoiseBudget::rate_allan_dph(double tau_s) const {
  return std::sqrt(rate_allan_variance(whole_records(tau_s)).total());
}

double NoiseBudget::frequency_allan_hz(double tau_s) const {
  return std::sqrt(frequency_allan_variance(whole_records(tau_s)).total());
}

}  // namespace hemi::loops

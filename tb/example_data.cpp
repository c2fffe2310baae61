// SPDX-License-Identifier: Apache-2.0
#include "tb/example_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "hls/config.hpp"

namespace hemi::examples {
namespace {

using Generator = std::mt19937_64;

constexpr double nominal_hz = 4425.0;
constexpr double nominal_amplitude = 0.8;  // of full scale
constexpr double secondary_in_phase = 0.02;
constexpr double secondary_quadrature = 0.05;
constexpr std::size_t longest_gap = 100;

constexpr double sample_rate_hz = 1.0;
constexpr double duration_s = 5.0 * 3600.0;
constexpr double hold_s = 600.0;
constexpr double chamber_tau_s = 300.0;
constexpr double resonator_tau_s = 2600.0;
constexpr double mount_tau_s = 400.0;
constexpr std::array frequency_hz = {4424.904653679655, 0.3748250360750196, -0.001047348484848916,
                                     6.641414141526992e-06, 2.159090909067223e-07};  // ascending, degC
constexpr double reference_hz = 4432.07;
constexpr double gradient_dph_per_degc = 0.15;
constexpr double rate_white_dph_rthz = 0.6;
constexpr double rate_flicker_dph_rthz = 0.03;
constexpr double frequency_white_hz_rthz = 2e-5;
constexpr double thermometer_degc = 0.01;

/// f(T) [Hz] and df/dT [Hz/degC].
std::array<double, 2> frequency_and_slope(double degc) {
  double value = 0.0, slope = 0.0;
  for (auto c = frequency_hz.rbegin(); c != frequency_hz.rend(); ++c) {
    slope = slope * degc + value;
    value = value * degc + *c;
  }
  return {value, slope};
}

/// Eq. (21) [deg/h]; f in Hz from the reference, df in Hz/s.
double drift_dph(double f, double df) {
  return 2.0 - 0.31 * f + 0.004 * f * f + 0.0004 * f * f * f + 850.0 * df + 2.0e4 * df * df + 12.0 * f * df;
}

/// One first-order thermal node.
class Node {
 public:
  Node(double start_degc, double tau_s)
      : degc_(start_degc), share_(-std::expm1(-1.0 / (sample_rate_hz * tau_s))) {}
  double step(double ahead_degc) { return degc_ += share_ * (ahead_degc - degc_); }

 private:
  double degc_;
  double share_;
};

/// Noise of density d / sqrt(f) from 1e-5 to 0.1 Hz: relaxations of time constants 1, 2, 4, ... s and of
/// equal variance v. Their one-sided spectra 4 v tau / (1 + (2 pi f tau)^2) add up to v / (f ln 2), so v =
/// d^2 ln 2.
class Flicker {
 public:
  Flicker(double density, Generator& generator) {
    const double deviation = density * std::sqrt(std::numbers::ln2);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const double keep = std::exp(-1.0 / (sample_rate_hz * std::exp2(static_cast<double>(k))));
      parts_[k] = {deviation * normal_(generator), keep, deviation * std::sqrt(1.0 - keep * keep)};
    }
  }
  double step(Generator& generator) {
    double sum = 0.0;
    for (Part& part : parts_) sum += part.value = part.keep * part.value + part.kick * normal_(generator);
    return sum;
  }

 private:
  struct Part {
    double value, keep, kick;
  };
  std::array<Part, 16> parts_{};
  std::normal_distribution<double> normal_;
};

/// Set point of the chamber [degC]: breakpoints joined by straight lines.
double chamber_degc(ChamberProfile profile, double time_s) {
  struct Point {
    double time_s, degc;
  };
  static const std::vector<Point> cool = {{hold_s, 23.0}, {hold_s + 2580.0, -20.0}};
  static const std::vector<Point> cycle = {
      {hold_s, 23.0}, {hold_s + 3960.0, -10.0}, {9000.0, -10.0}, {9000.0 + 3960.0, 23.0}};
  static const std::vector<Point> warm = {{hold_s, -20.0}, {hold_s + 3600.0, 40.0}};
  const auto& points = profile == ChamberProfile::cool    ? cool
                       : profile == ChamberProfile::cycle ? cycle
                                                          : warm;
  if (time_s <= points.front().time_s) return points.front().degc;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point &a = points[i - 1], &b = points[i];
    if (time_s < b.time_s) return std::lerp(a.degc, b.degc, (time_s - a.time_s) / (b.time_s - a.time_s));
  }
  return points.back().degc;
}

/// Standard deviation of samples of white noise of a one-sided density.
double sample_deviation(double density_rthz) {
  return density_rthz * std::sqrt(sample_rate_hz / 2.0);
}

}  // namespace

recording::RawCapture make_capture(const CaptureOptions& options) {
  Generator generator(options.seed);
  std::normal_distribution<double> noise(0.0, options.noise_lsb);
  recording::RawCapture capture;
  capture.device =
      options.wide ? "synthetic resonator, wide instrument" : "synthetic resonator, reference instrument";
  capture.sample_rate_hz = options.wide ? config::Wide::adc_rate_hz : config::Reference::adc_rate_hz;
  capture.full_scale_lsb =
      std::ldexp(1.0, (options.wide ? config::Wide::adc_bits : config::Reference::adc_bits) - 1);
  std::bernoulli_distribution gap_starts(options.gaps_per_s / capture.sample_rate_hz);
  std::uniform_int_distribution<std::size_t> gap_length(1, longest_gap);
  const auto adc = [&](double of_full_scale) {
    const double lsb = std::round(of_full_scale * capture.full_scale_lsb + noise(generator));
    return static_cast<std::int32_t>(std::clamp(lsb, -capture.full_scale_lsb, capture.full_scale_lsb - 1.0));
  };
  const auto samples = static_cast<std::size_t>(std::llround(options.seconds * capture.sample_rate_hz));
  for (std::size_t i = 0; i < samples; ++i) {
    if (i > 0 && gap_starts(generator)) {
      const std::size_t lost = gap_length(generator);
      if (i + lost >= samples) break;
      capture.gaps.push_back({static_cast<double>(i - 1) / capture.sample_rate_hz,
                              static_cast<double>(i + lost) / capture.sample_rate_hz,
                              capture.adc_x.size() - 1, lost});
      i += lost;
    }
    const double t = static_cast<double>(i) / capture.sample_rate_hz;
    const double turns = (nominal_hz + options.offset_hz + 0.5 * options.drift_hz_per_s * t) * t;
    const double theta = 2.0 * std::numbers::pi * (turns - std::floor(turns));
    const double a = nominal_amplitude * std::exp(-t / options.damping_s);
    capture.adc_x.push_back(adc(a * std::cos(theta)));
    capture.adc_y.push_back(
        adc(a * (secondary_in_phase * std::cos(theta) - secondary_quadrature * std::sin(theta))));
  }
  return capture;
}

recording::Recording make_chamber_run(ChamberProfile profile, std::uint64_t seed) {
  Generator generator(seed);
  std::normal_distribution<double> normal;
  Flicker flicker(rate_flicker_dph_rthz, generator);
  const double start_degc = chamber_degc(profile, 0.0);
  Node housing(start_degc, chamber_tau_s), resonator(start_degc, resonator_tau_s),
      mount(start_degc, mount_tau_s);
  const auto rows = static_cast<std::size_t>(duration_s * sample_rate_hz);
  std::vector<double> time(rows), temperature(rows), frequency(rows), rate(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    time[i] = static_cast<double>(i) / sample_rate_hz;
    const double housing_degc = housing.step(chamber_degc(profile, time[i]));
    const double degc = resonator.step(housing_degc);
    const double gradient_degc = housing_degc - mount.step(housing_degc);
    const auto [f, slope] = frequency_and_slope(degc);
    const double df = slope * (housing_degc - degc) / resonator_tau_s;
    temperature[i] = housing_degc + thermometer_degc * normal(generator);
    frequency[i] = f + sample_deviation(frequency_white_hz_rthz) * normal(generator);
    rate[i] = drift_dph(f - reference_hz, df) + gradient_dph_per_degc * gradient_degc +
              flicker.step(generator) + sample_deviation(rate_white_dph_rthz) * normal(generator);
  }
  recording::Recording run;
  run.device = "synthetic HRG";
  run.sample_rate_hz = sample_rate_hz;
  run.channels = {{"time_s", "s", std::move(time)},
                  {"case_temp_degc", "degC", std::move(temperature)},
                  {"frequency_hz", "Hz", std::move(frequency)},
                  {"rate_dph", "deg/h", std::move(rate)}};
  run.sidecar["notes"] = "synthetic chamber run; its physics is written in tb/example_data.hpp";
  return run;
}

}  // namespace hemi::examples

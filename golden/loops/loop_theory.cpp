// SPDX-License-Identifier: Apache-2.0
#include "golden/loops/loop_theory.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "hls/config.hpp"

namespace hemi::loops {
namespace {

constexpr std::complex<double> kJ{0.0, 1.0};

/// sin(pi n x) / (n sin(pi x)): mean of n samples.
double mean_response(double n, double x) {
  return x == 0.0 ? 1.0 : std::sin(std::numbers::pi * n * x) / (n * std::sin(std::numbers::pi * x));
}

/// Highest frequency at which `above(f)` holds, by steps of 2 % downwards from `from_hz` and bisection.
template <class Above>
double highest(double from_hz, const Above& above) {
  double high = from_hz;
  double low = high;
  while (!above(low)) {
    high = low;
    low *= 0.98;
    if (low < 1e-9 * from_hz) return 0.0;
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (above(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::complex<double> LoopPlant::response(double frequency_hz) const {
  const std::complex<double> s = kJ * (2.0 * std::numbers::pi * frequency_hz);
  const double x = frequency_hz / adc_rate_hz;
  const double front_end = std::pow(mean_response(decimation, x), config::cic_order);
  std::complex<double> image = 0.0;
  double sum = 0.0;
  for (int i = 0; i < 5; ++i) {
    image += double(config::image_taps[i]) * std::exp(-s * double((i - 2) * decimation) / adc_rate_hz);
    sum += config::image_taps[i];
  }
  return gain_per_s / (s + pole_per_s) * mean_response(decimation, x) * front_end * (image / sum) *
         std::exp(-s * delay_samples / adc_rate_hz);
}

std::complex<double> Loop::open(double frequency_hz) const {
  const double tick_s = plant.decimation / plant.adc_rate_hz;
  const std::complex<double> delay = std::exp(-kJ * (2.0 * std::numbers::pi * frequency_hz * tick_s));
  return (gains.proportional + gains.integral / (1.0 - delay)) * plant.response(frequency_hz);
}

std::complex<double> Loop::closed(double frequency_hz) const {
  const std::complex<double> l = open(frequency_hz);
  return l / (1.0 + l);
}

double Loop::crossover_hz() const {
  return highest(0.5 * plant.adc_rate_hz / plant.decimation,
                 [this](double f) { return std::abs(open(f)) >= 1.0; });
}

double Loop::phase_margin_deg() const {
  return 180.0 + std::arg(open(crossover_hz())) * 180.0 / std::numbers::pi;
}

double Loop::bandwidth_hz() const {
  return highest(0.5 * plant.adc_rate_hz / plant.decimation,
                 [this](double f) { return std::abs(closed(f)) >= std::numbers::sqrt2 / 2.0; });
}

LoopGains design(const LoopPlant& plant, double bandwidth_hz, double zero_ratio, double least_margin_deg) {
  const double tick_s = plant.decimation / plant.adc_rate_hz;
  if (!(bandwidth_hz > 0.0 && bandwidth_hz < 0.05 / tick_s)) {
    throw std::invalid_argument(
        fmt::format("a bandwidth of {} Hz is not between 0 and a twentieth of the loop rate", bandwidth_hz));
  }
  const auto at = [&](double crossover_hz) {
    const double w = 2.0 * std::numbers::pi * crossover_hz;
    const double kp = w / plant.gain_per_s;
    return Loop{plant, {kp, kp * zero_ratio * w * tick_s}};
  };
  double low = 0.1 * bandwidth_hz;
  double high = 2.0 * bandwidth_hz;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (at(middle).bandwidth_hz() > bandwidth_hz ? high : low) = middle;
  }
  const Loop loop = at(0.5 * (low + high));
  if (const double margin = loop.phase_margin_deg(); margin < least_margin_deg) {
    throw std::invalid_argument(
        fmt::format("{} Hz leave a phase margin of {:.1f} degrees, less than {:.0f}; ask for less",
                    bandwidth_hz, margin, least_margin_deg));
  }
  return loop.gains;
}

}  // namespace hemi::loops

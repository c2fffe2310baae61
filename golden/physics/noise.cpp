// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/noise.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hemi::physics {

namespace {

const double kPoleRatio = std::sqrt(10.0);

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

RandomBits::RandomBits(std::uint64_t seed, std::uint64_t stream) {
  // mixed twice, so that seed 1 of stream 0 is not seed 0 of stream 1
  std::uint64_t state = mix(mix(seed + 0x9e3779b97f4a7c15u) + stream);
  for (std::uint64_t& word : s_) word = mix(state += 0x9e3779b97f4a7c15u);
}

FlickerNoise::FlickerNoise(double h, double lowest_hz, double highest_hz, std::uint64_t seed,
                           std::uint64_t stream)
    : deviation_(std::sqrt(h * std::log(kPoleRatio))), gaussian_(seed, stream) {
  if (!(h >= 0.0 && lowest_hz > 0.0 && highest_hz > lowest_hz)) {
    throw std::invalid_argument("flicker noise: h must not be negative, and 0 < lowest_hz < highest_hz");
  }
  const double margin = std::pow(kPoleRatio, 3);
  // a little more than the last corner, so that rounding does not decide over it
  for (double corner_hz = lowest_hz / margin; corner_hz < 1.1 * highest_hz * margin;
       corner_hz *= kPoleRatio) {
    poles_.push_back({corner_hz, deviation_ * gaussian_(), 0.0, 0.0});
  }
}

void FlickerNoise::set_interval(double dt_s) {
  dt_s_ = dt_s;
  for (Pole& pole : poles_) {
    const double exponent = -2.0 * std::numbers::pi * pole.corner_hz * dt_s;
    pole.decay = std::exp(exponent);
    pole.input = deviation_ * std::sqrt(-std::expm1(2.0 * exponent));
  }
}

double FlickerNoise::advance(double dt_s) {
  if (dt_s != dt_s_) set_interval(dt_s);
  double sum = 0.0;
  for (Pole& pole : poles_) {
    pole.value = pole.decay * pole.value + pole.input * gaussian_();
    sum += pole.value;
  }
  return sum;
}

double FlickerNoise::density(double frequency_hz) const {
  double sum = 0.0;
  for (const Pole& pole : poles_) {
    const double ratio = frequency_hz / pole.corner_hz;
    sum += 2.0 * deviation_ * deviation_ / (std::numbers::pi * pole.corner_hz * (1.0 + ratio * ratio));
  }
  return sum;
}

double FlickerNoise::h_of_floor(double allan_deviation) {
  return allan_deviation * allan_deviation / (2.0 * std::numbers::ln2);
}

double RandomWalk::advance(double dt_s) {
  value_ += density_ * std::sqrt(dt_s) * gaussian_();
  return value_;
}

double white_deviation(double density_rthz, double rate_hz) {
  return density_rthz * std::sqrt(rate_hz / 2.0);
}

}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/noise.hpp"

#include <bit>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace hemi::concealed {
namespace {

double draw(NoiseLevel::Shape shape, Random& random) {
  switch (shape) {
    case NoiseLevel::Shape::kHeavyTailed:
      return random.heavy_tailed();
    case NoiseLevel::Shape::kLaplace:
      return random.laplace();
    default:
      return random.normal();
  }
}

Series coloured(const NoiseLevel& level, Eigen::Index count, Random& random) {
  NoiseLevel colour = level;
  colour.white = 0.0;
  const auto length = static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::size_t>(2 * count)));
  Eigen::VectorXcd spectrum = Eigen::VectorXcd::Zero(length);
  const double n = static_cast<double>(length);
  for (Eigen::Index k = 1; k < length / 2; ++k) {
    // Variance of a line: half the density times the line's width, in each of two quadratures.
    const double amplitude = std::sqrt(density(colour, static_cast<double>(k) / n) / n);
    const std::complex<double> line(random.normal(), random.normal());
    spectrum[k] = 0.5 * n * amplitude * line;
    spectrum[length - k] = std::conj(spectrum[k]);
  }
  thread_local Eigen::FFT<double> fft;  // keeps its tables
  Eigen::VectorXcd series(length);
  fft.inv(series, spectrum);
  return series.real().head(count).array();
}

}  // namespace

double density(const NoiseLevel& level, double frequency_hz) {
  const double rising = level.differenced * std::sin(std::numbers::pi * frequency_hz) / std::numbers::pi;
  return level.white * level.white + level.flicker * level.flicker / frequency_hz +
         level.random_walk * level.random_walk / (frequency_hz * frequency_hz) + rising * rising;
}

Series noise(const NoiseLevel& level, Eigen::Index count, Random& random) {
  const double deviation = level.white * std::sqrt(0.5);  // one-sided density up to 0.5 Hz
  Series sum(count);
  for (Eigen::Index i = 0; i < count; ++i) sum[i] = deviation * draw(level.shape, random);
  if (level.flicker > 0.0 || level.random_walk > 0.0 || level.differenced > 0.0)
    sum += coloured(level, count, random);
  return sum;
}

}  // namespace hemi::concealed

// SPDX-License-Identifier: Apache-2.0
// nco, demodulator, cic and image_filter against their equations.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "hls/cic.hpp"
#include "hls/demodulator.hpp"
#include "hls/image_filter.hpp"

namespace {

using namespace hemi;
using namespace hemi::hls;

TEST(Nco, EveryTableLineAndMirrorWithinTheInterpolationError) {
  // Chord of a sine over h = pi/1024 rad: h^2/8; base and delta rounded to 2^-20: 2^-20; result: 2^-20; full
  // scale 2^-19 low.
  const double h = std::numbers::pi / 1024;
  const double bound = h * h / 8 + std::ldexp(1.0, -20) * 2 + std::ldexp(1.0, -19);
  Nco nco;
  nco.reset();
  // Steps of an odd number of 2^-24 turns visit every line of every quadrant.
  const std::int64_t step = 8191 * (std::int64_t{1} << 24) + (std::int64_t{1} << 20);
  double worst = 0;
  for (int n = 0; n < 200000; ++n) {
    const double turns = std::ldexp(static_cast<double>(raw(nco.phase()) >> 24), -24) + std::ldexp(1.0, -25);
    const SinCos out = nco.output();
    worst =
        std::max(worst, std::abs(std::ldexp(raw(out.cosine), -19) - std::cos(2 * std::numbers::pi * turns)));
    worst =
        std::max(worst, std::abs(std::ldexp(raw(out.sine), -19) - std::sin(2 * std::numbers::pi * turns)));
    nco.advance(from_raw<Increment>(step));
  }
  EXPECT_LE(worst, bound);
}

TEST(Nco, PhaseWrapsAfterThirtyTwoTurns) {
  Nco nco;
  nco.reset();
  const std::int64_t quarter = std::int64_t{1} << 46;
  for (int n = 0; n < 128; ++n) nco.advance(from_raw<Increment>(quarter));
  EXPECT_EQ(raw(nco.phase()), 0);
}

TEST(Demodulator, ProductsRoundHalfUpAndNegateAfterwards) {
  using D = Demodulator<config::Reference>;
  Product p[channels];
  // 3 * 341.33 LSB: 1 * 1024 / 2^11 is exactly one half of the product's unit.
  D::mix(from_raw<D::Adc>(1), from_raw<D::Adc>(-1), {from_raw<Sine>(1024), from_raw<Sine>(1024)}, p);
  EXPECT_EQ(raw(p[0]), 1);   // +1/2 up
  EXPECT_EQ(raw(p[1]), -1);  // -(+1/2 up)
  EXPECT_EQ(raw(p[2]), 0);   // -1/2 up
  EXPECT_EQ(raw(p[3]), 0);
  const std::int64_t top = (1 << 19) - 1;
  D::mix(from_raw<D::Adc>(-32768), from_raw<D::Adc>(32767), {from_raw<Sine>(top), from_raw<Sine>(-top)}, p);
  EXPECT_EQ(raw(p[0]), -(32768 * top) / 2048);
  EXPECT_EQ(raw(p[1]), -(32768 * top) / 2048);
}

/// Coefficients of ((1 - z^-R) / (1 - z^-1))^5.
std::vector<std::int64_t> cic_coefficients(int decimation) {
  std::vector<std::int64_t> h = {1};
  for (int stage = 0; stage < 5; ++stage) {
    std::vector<std::int64_t> next(h.size() + static_cast<std::size_t>(decimation) - 1, 0);
    for (std::size_t i = 0; i < h.size(); ++i) {
      for (int k = 0; k < decimation; ++k) next[i + static_cast<std::size_t>(k)] += h[i];
    }
    h = next;
  }
  return h;
}

template <class Instrument>
void expect_cic_is_convolution() {
  const auto h = cic_coefficients(Instrument::decimation);
  std::mt19937 generator(3);
  std::uniform_int_distribution<int> sign(0, 1);
  std::vector<std::int64_t> input;
  Cic<Instrument> cic;
  cic.reset();
  constexpr std::int64_t top = (1 << 23) - 1;
  for (int n = 0; n < 400 * Instrument::decimation; ++n) {
    // Full scale: constant first, so that the integrators wrap many times, then random signs.
    input.push_back(n < 200 * Instrument::decimation || sign(generator) ? top : -top - 1);
    cic.integrate(from_raw<Product>(input.back()));
    if ((n + 1) % Instrument::decimation != 0) continue;
    std::int64_t sum = 0;
    for (std::size_t k = 0; k < h.size() && k < input.size(); ++k) sum += h[k] * input[input.size() - 1 - k];
    const int shift = Instrument::cic_growth - 4;
    ASSERT_EQ(raw(cic.decimate()), (sum + (std::int64_t{1} << (shift - 1))) >> shift) << n;
  }
}

TEST(Cic, IsTheConvolutionAtFullScaleReference) {
  expect_cic_is_convolution<config::Reference>();
}
TEST(Cic, IsTheConvolutionAtFullScaleWide) {
  expect_cic_is_convolution<config::Wide>();
}

TEST(ImageFilter, ImpulseResponseGainAndZero) {
  ImageFilter filter;
  filter.reset();
  std::vector<double> h;
  constexpr std::int64_t impulse = 1 << 20;
  for (int n = 0; n < 8; ++n)
    h.push_back(std::ldexp(raw(filter.step(from_raw<Baseband>(n == 0 ? impulse : 0))), -20));
  const double expected[8] = {16 / 64., -8 / 64., 33 / 64., -8 / 64., 16 / 64., 0, 0, 0};
  for (int n = 0; n < 8; ++n) EXPECT_EQ(h[static_cast<std::size_t>(n)], expected[n]);
  // A double zero at cos w = 1/8, 1150.3 Hz of 5 kHz.
  const double w = std::acos(0.125);
  double re = 0, im = 0;
  for (int n = 0; n < 5; ++n) {
    re += expected[n] * std::cos(n * w);
    im += expected[n] * std::sin(n * w);
  }
  EXPECT_NEAR(std::hypot(re, im), 0.0, 1e-15);
  EXPECT_NEAR(w / (2 * std::numbers::pi) * 5000, 1150.3, 0.05);
}

TEST(ImageFilter, TakesTheCicsLargestOutputWithoutOverflow) {
  // The cic's bound 2^23 R^5 / 2^(g-4), alternating to match the signs of the taps, both instruments.
  for (const double largest : {std::pow(20, 5) * 128.0 * 1024 / 64, std::pow(50, 5) * 1024 / 4.0}) {
    ImageFilter filter;
    filter.reset();
    const int signs[5] = {1, -1, 1, -1, 1};
    const auto u = static_cast<std::int64_t>(std::min(largest, std::ldexp(1.0, 27) * 0.78));
    std::int64_t out = 0;
    for (const int s : signs) out = raw(filter.step(from_raw<Baseband>(s * u)));
    EXPECT_EQ(out, (81 * u + 32) >> 6);
  }
}

}  // namespace

// SPDX-License-Identifier: Apache-2.0
// rate_filter, thermometer, derivative, bias_model, status and registers against their equations.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "hls/bias_model.hpp"
#include "hls/derivative.hpp"
#include "hls/rate_filter.hpp"
#include "hls/status.hpp"
#include "hls/thermometer.hpp"

namespace {

using namespace hemi;
using namespace hemi::hls;

TEST(RateFilter, TriangularWeightsOfTwoIntervals) {
  const auto gain = from_raw<RegisterWord<config::reg_rate_gain>>(1 << 13);  // 1 deg/h / 625
  for (int at = 0; at < 50; ++at) {
    RateFilter filter;
    filter.reset();
    bool saturated = false;
    double out[4];
    for (int m = 0; m < 4; ++m) {
      for (int i = 0; i < 25; ++i)
        filter.step(from_raw<Baseband>(m * 25 + i == at ? 1 << 26 : 0), gain, saturated);
      out[m] = std::ldexp(raw(filter.rate(saturated)), -16);
    }
    // One half at tick `at`: weight 25 - |at - 25 m| in output m.
    for (int m = 0; m < 4; ++m)
      EXPECT_EQ(out[m], 0.5 * std::max(0, 25 - std::abs(at - 25 * m))) << at << " " << m;
    EXPECT_FALSE(saturated);
  }
}

Registers registers_with(void (*change)(std::int64_t (&image)[config::register_count])) {
  std::int64_t image[config::register_count] = {};
  change(image);
  Registers r;
  r.load(image);
  return r;
}

TEST(Thermometer, PolynomialWithinItsRounding) {
  const Registers r = registers_with([](auto& image) {
    image[config::reg_frequency_reference] = std::llround(std::ldexp(4432.07, 29));
    const double c[6] = {20.0, 176.0, 12.0, -33.0, 5.0, -1.5};
    for (int i = 0; i < 6; ++i) image[config::reg_thermometer_0 + i] = std::llround(std::ldexp(c[i], 19));
  });
  for (double f = 4400; f < 4470; f += 0.37) {
    bool range = false, saturated = false;
    const auto frequency = from_raw<Frequency>(std::llround(std::ldexp(f, 29)));
    const Offset o = Thermometer::offset(Thermometer::difference(frequency, r), range);
    const double x = std::ldexp(raw(o), -23);
    EXPECT_NEAR(x, (f - 4432.07) / 64, std::ldexp(1.0, -24) + 1e-10);
    const double t = std::ldexp(raw(Thermometer::temperature(o, r, saturated)), -19);
    const double exact = 20 + x * (176 + x * (12 + x * (-33 + x * (5 - 1.5 * x))));
    EXPECT_NEAR(t, exact, 5 * std::ldexp(1.0, -20) / (1 - std::min(0.9, std::abs(x))));
    EXPECT_FALSE(range || saturated);
  }
  bool range = false;
  const auto far = from_raw<Frequency>(std::llround(std::ldexp(4432.07 + 64.01, 29)));
  EXPECT_EQ(raw(Thermometer::offset(Thermometer::difference(far, r), range)), (1 << 23) - 1);
  EXPECT_TRUE(range);
}

TEST(Derivative, ExactOnARampAndInvalidUntilFull) {
  const Registers r = registers_with([](auto& image) {
    image[config::reg_log2_block] = 2;
    image[config::reg_slope_shift] = 9;
    image[config::reg_slope_gain] = 1 << 22;  // one half
  });
  DerivativeFilter filter;
  filter.reset();
  bool saturated = false;
  const std::int64_t per_output = 1 << 10;  // raw f29: 64 units of 2^-25 Hz
  for (int m = 0; m < 200; ++m) {
    const auto d =
        filter.step(quantise<Thermometer::Difference>(from_raw<Thermometer::Difference>(m * per_output)),
                    true, r, saturated);
    EXPECT_EQ(filter.valid(), m >= 63);
    if (m < 63) {
      EXPECT_EQ(raw(d), 0);
      continue;
    }
    // Block sums rise by 4 * 4 * 64 units a block: sum (2j - 15) j = 680 of them.
    const std::int64_t slope_sum = 680LL * 16 * 64;
    EXPECT_EQ(raw(filter.slope_sum()), slope_sum);
    const std::int64_t v = (slope_sum + 256) >> 9;
    EXPECT_EQ(raw(d), (v * (1 << 22) + (1 << 28)) >> 29);
  }
  filter.step(from_raw<Thermometer::Difference>(0), false, r, saturated);
  EXPECT_FALSE(filter.valid());
  EXPECT_FALSE(saturated);
}

TEST(BiasModel, AllTenTermsWithinTheirRounding) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> coefficient(-900, 900), unit(-1, 1);
  for (int n = 0; n < 2000; ++n) {
    Registers r;
    std::int64_t image[config::register_count] = {};
    double k[10];
    for (int i = 0; i < 10; ++i) {
      image[config::reg_bias_0 + i] = std::llround(std::ldexp(coefficient(generator), 13));
      k[i] = std::ldexp(image[config::reg_bias_0 + i], -13);
    }
    r.load(image);
    const auto o = from_raw<Offset>(std::llround(std::ldexp(unit(generator), 22)));
    const auto g = from_raw<Derivative>(std::llround(std::ldexp(unit(generator), 22)));
    const double f = std::ldexp(raw(o), -23), d = std::ldexp(raw(g), -23);
    bool saturated = false;
    const double b = std::ldexp(raw(BiasModel::bias(o, g, r, saturated)), -13);
    const double exact = k[0] + k[1] * f + k[2] * f * f + k[3] * f * f * f + k[4] * d + k[5] * d * d +
                         k[6] * d * d * d + k[7] * f * d + k[8] * f * f * d + k[9] * f * d * d;
    EXPECT_NEAR(b, exact, 9 * std::ldexp(1.0, -14));  // nine roundings of half a unit, factors below 1
    EXPECT_FALSE(saturated);
  }
}

TEST(BiasModel, CompensationUsesTheScaleFactor) {
  const Registers r = registers_with(
      [](auto& image) { image[config::reg_scale_correction] = std::llround(std::ldexp(1 / 1.05 - 1, 23)); });
  bool saturated = false;
  for (double rate = -400000; rate < 400000; rate += 12345.678) {
    const auto in = from_raw<Rate>(std::llround(std::ldexp(rate, 16)));
    const auto bias = from_raw<Bias>(std::llround(std::ldexp(7.5, 13)));
    const double out = std::ldexp(raw(BiasModel::compensate(in, bias, r, saturated)), -16);
    // The correction's own unit 2^-24 on the rate, its operand cut to 2^-11, the result rounded.
    EXPECT_NEAR(out, (rate - 7.5) / 1.05,
                std::abs(rate) * std::ldexp(1.0, -24) + 0.05 * std::ldexp(1.0, -11) + std::ldexp(1.0, -15));
  }
  EXPECT_FALSE(saturated);
}

TEST(Status, StickyFromTheFirstLockOn) {
  Status status;
  status.reset();
  status.raise(config::status_unlocked, true);
  status.raise(config::status_adc_overload, true);
  EXPECT_EQ(status.close(), (1 << config::status_unlocked) | (1 << config::status_adc_overload));
  status.raise(config::status_sample_gap, true);
  EXPECT_EQ(status.close(), (1 << config::status_sample_gap) * 0x1000001LL);
  EXPECT_EQ(status.close(), (1LL << config::status_sample_gap) << config::status_shift);
  status.raise(config::status_unlocked, true);
  EXPECT_EQ(status.close(), ((1LL << config::status_sample_gap | 1) << config::status_shift) | 1);
}

TEST(Registers, ParityCoversEveryBit) {
  std::int64_t image[config::register_count] = {};
  for (int i = 0; i < config::reg_parity; ++i) {
    image[i] = (i * 7919LL + 13) % (1LL << (std::min(config::registers[i].format.width, 20) - 1));
    image[config::reg_parity] ^= image[i];
  }
  Registers r;
  r.load(image);
  EXPECT_FALSE(r.parity_error);
  for (int i = 0; i < config::register_count; ++i) {
    for (int b = 0; b < config::registers[i].format.width; ++b) {
      image[i] ^= std::int64_t{1} << b;
      r.load(image);
      EXPECT_TRUE(r.parity_error) << i << " " << b;
      image[i] ^= std::int64_t{1} << b;
    }
  }
}

}  // namespace

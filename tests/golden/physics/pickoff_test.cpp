// SPDX-License-Identifier: Apache-2.0
// Pickoffs and ADC of the plant.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/golden/physics/plant_support.hpp"

namespace hemi::physics {
namespace {

constexpr double kPi = std::numbers::pi;

using testing::lossless;
using testing::silent;

AdcPair first_sample(const Parameters& p, const InitialVibration& start, AdcConfiguration adc) {
  PlantConfiguration configuration;
  configuration.adc = adc;
  configuration.start = start;
  return Plant(silent(), p, configuration).sample();
}

TEST(Pickoff, NominalAmplitudeIsEightTenthsOfFullScale) {
  const Parameters p = lossless(silent());
  for (const AdcConfiguration adc : {AdcConfiguration::reference(), AdcConfiguration::wide()}) {
    const double full_scale = 1 << (adc.bits - 1);
    const AdcPair words = first_sample(p, {1.0, 0.0, 0.5, kPi}, adc);
    EXPECT_EQ(words.x, std::lround(0.8 * full_scale));
    EXPECT_EQ(words.y, std::lround(-0.4 * full_scale));
  }
}

TEST(Pickoff, BendsByItsPolynomial) {
  Parameters p = lossless(silent());
  p.pickoff_gain_x = 1.01;
  p.pickoff_gain_y = 0.98;
  p.pickoff_quadratic = 0.02;
  p.pickoff_cubic = -0.03;
  const AdcPair words = first_sample(p, {0.9, 0.0, 0.7, kPi}, AdcConfiguration::reference());
  const auto bent = [](double u) { return u + 0.02 * u * u - 0.03 * u * u * u; };
  EXPECT_EQ(words.x, std::lround(32768 * 0.8 * 1.01 * bent(0.9)));
  EXPECT_EQ(words.y, std::lround(32768 * 0.8 * 0.98 * bent(-0.7)));
}

TEST(Pickoff, ElectronicsOfTheSecondaryLead) {
  Parameters p = lossless(silent());
  p.pickoff_phase_y_rad = 0.1;
  for (const double phase : {0.0, 1.0, 2.0, 4.0}) {
    const AdcPair words = first_sample(p, {1.0, phase, 1.0, phase}, AdcConfiguration::reference());
    EXPECT_EQ(words.x, std::lround(32768 * 0.8 * std::cos(phase)));
    EXPECT_NEAR(words.y, 32768 * 0.8 * std::cos(phase + 0.1), 0.5 + 1e-6);
  }
}

// The word of sample 0 acts from instant 2 to 3, and the pickoff is sampled at the end of that interval.
TEST(Pickoff, FeelsTheDriveThatIsHeld) {
  const Instrument instrument = silent();
  Parameters p = lossless(instrument);
  p.drive_feedthrough = 0.01;
  Plant plant(instrument, p, PlantConfiguration{});
  std::vector<std::int32_t> x;
  for (int n = 0; n < 5; ++n) {
    x.push_back(plant.sample().x);
    plant.act({static_cast<std::int16_t>(n == 0 ? 16384 : 0), 0, 0});
  }
  EXPECT_EQ(x, (std::vector<std::int32_t>{0, 0, 0, 164, 0}));
}

TEST(Pickoff, OffsetsBelongToTheirChannels) {
  Parameters p = lossless(silent());
  p.adc_offset_lsb = {3.0, -2.0};
  const AdcPair words = first_sample(p, {}, AdcConfiguration::wide());
  EXPECT_EQ(words.x, 12);
  EXPECT_EQ(words.y, -8);
}

}  // namespace
}  // namespace hemi::physics

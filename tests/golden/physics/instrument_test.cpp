// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/instrument.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hemi::physics {
namespace {

constexpr double kPi = std::numbers::pi;

// Rows of the published table of soaks, which the cubic meets within its largest residual, 0.027 Hz.
TEST(Instrument, FrequencyFollowsThePublishedCubic) {
  const Instrument instrument;
  EXPECT_NEAR(instrument.at(0.0).omega_rad_s / (2.0 * kPi), 4424.90095, 1e-9);
  const double slope = (instrument.at(0.5).omega_rad_s - instrument.at(-0.5).omega_rad_s) / (2.0 * kPi);
  EXPECT_NEAR(slope / 4424.901, 84.0e-6, 0.05e-6);
  // the quadratic term is negative
  EXPECT_NEAR(instrument.at(-20.0).omega_rad_s / (2.0 * kPi),
              4424.90095 - 20.0 * 0.371555556 - 400.0 * 9.70238095e-4 - 8000.0 * 1.52777778e-5, 1e-9);
}

TEST(Instrument, QualityFactorOfTenMillionRingsForTwelveMinutes) {
  EXPECT_NEAR(1.0 / Instrument{}.at(20.0).damping_per_s, 719.0, 1.0);
}

TEST(Instrument, ScalesAreThoseOfTheDataSheet) {
  const Instrument instrument;
  const Parameters p = instrument.at(20.0);
  EXPECT_NEAR(std::hypot(p.mismatch_cos_per_s, p.mismatch_sin_per_s) / p.damping_per_s, 0.01, 1e-12);
  EXPECT_NEAR(std::atan2(p.mismatch_sin_per_s, p.mismatch_cos_per_s) * 90.0 / kPi, 11.25, 1e-9);
  EXPECT_NEAR(std::hypot(p.split_cos_rad_s, p.split_sin_rad_s) / (2.0 * kPi), 1e-3, 1e-12);
  EXPECT_NEAR(std::atan2(p.split_sin_rad_s, p.split_cos_rad_s) * 90.0 / kPi, 22.5, 1e-9);
  EXPECT_NEAR(p.drive_per_s / p.damping_per_s, 400.0, 1e-9);
  EXPECT_NEAR(p.rebalance_per_s / p.kappa * 180.0 / kPi, 120.0, 1e-9);
  EXPECT_NEAR(p.quadrature_span_rad_s / (2.0 * kPi), 0.05, 1e-12);
}

// Drive electronics do not follow the shell's damping; mismatch and split do follow their polynomials.
TEST(Instrument, FollowsTheShellsTemperature) {
  const Instrument instrument;
  const Parameters cold = instrument.at(-20.0);
  const Parameters nominal = instrument.at(20.0);
  EXPECT_NEAR(cold.damping_per_s / nominal.damping_per_s, 1.0 - 40.0 * 0.002, 1e-12);
  EXPECT_NEAR(cold.mismatch_sin_per_s / nominal.mismatch_sin_per_s, 1.0 - 40.0 * 0.002, 1e-12);
  EXPECT_NEAR(cold.split_cos_rad_s / nominal.split_cos_rad_s, 1.0 - 40.0 * 0.002, 1e-12);
  EXPECT_EQ(cold.drive_per_s, nominal.drive_per_s);
  EXPECT_EQ(cold.rebalance_per_s, nominal.rebalance_per_s);
}

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
// Intervals hold what they promise: 100 recordings, standard errors against true errors.
#include <gtest/gtest.h>

#include <cmath>

#include "golden/calibration/settled_fit.hpp"
#include "tests/golden/calibration/chamber_recording.hpp"

namespace hemi::calibration {
namespace {

constexpr int kRecordings = 100;

// Counts inside 95 % intervals are binomial: 95 +- 2.2 of 100; four standard deviations below is 86. The
// noise model is estimated from the same rows, which widens the true scatter by a few per cent at these
// lengths.
constexpr int kLeastInside = 86;

TEST(ThermalCoverage, TimeConstantAndCoefficients) {
  const testing::Instrument instrument;
  int tau_inside = 0, settled_inside = 0;
  std::array<int, 4> inside{};
  for (int i = 0; i < kRecordings; ++i) {
    const std::vector<ThermalStretch> stretches = {
        testing::chamber_recording(instrument, testing::seven_soaks(), 7 * 4.5 * 3600.0,
                                   5000 + static_cast<std::uint64_t>(i))
            .stretch()};
    const auto fit = fit_thermal(stretches);
    const auto settled =
        fit_settled(stretches, find_holds(stretches).used, fit.polynomial, fit.time_constant_s, fit.lag_s);
    tau_inside += std::abs(fit.time_constant_s - 2600.0) < 1.96 * fit.time_constant_error_s ? 1 : 0;
    settled_inside +=
        std::abs(settled.time_constant_s - 2600.0) < 1.96 * settled.time_constant_error_s ? 1 : 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      inside[k] += std::abs(fit.polynomial.coefficients_hz()[at] - instrument.coefficients_hz[k]) <
                           1.96 * fit.standard_errors[at]
                       ? 1
                       : 0;
    }
  }
  EXPECT_GE(tau_inside, kLeastInside);
  EXPECT_GE(settled_inside, kLeastInside);
  for (const int count : inside) EXPECT_GE(count, kLeastInside);
}

}  // namespace
}  // namespace hemi::calibration

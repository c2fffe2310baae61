// SPDX-License-Identifier: Apache-2.0
// Chamber recordings with a known truth back to f(T), time constant and settled values.
#include "golden/calibration/thermal_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "golden/calibration/order_study.hpp"
#include "golden/calibration/settled_fit.hpp"
#include "tests/golden/calibration/chamber_recording.hpp"

namespace hemi::calibration {
namespace {

using testing::chamber_recording;
using testing::Instrument;
using testing::seven_soaks;

double true_hz(const Instrument& instrument, double degc) {
  double f = 0.0;
  for (std::size_t k = instrument.coefficients_hz.size(); k-- > 0;)
    f = f * degc + instrument.coefficients_hz[k];
  return f;
}

// Seven soaks of 4.5 h, of which the approach leaves 5 to 60 mHz unsettled.
class SevenSoaks : public ::testing::Test {
 protected:
  static std::vector<ThermalStretch> record(std::uint64_t seed, const Instrument& instrument = {}) {
    return {chamber_recording(instrument, seven_soaks(), 7 * 4.5 * 3600.0, seed).stretch()};
  }
};

TEST_F(SevenSoaks, HoldsAreFound) {
  const auto stretches = record(1);
  const Holds holds = find_holds(stretches);
  ASSERT_EQ(holds.used.size(), 7U);
  EXPECT_TRUE(holds.refused.empty());
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(holds.used[i].case_degc, -20.0 + 10.0 * static_cast<double>(i), 0.005);
    const double begin_s = 4.5 * 3600.0 * static_cast<double>(i);
    const double ramp_s = 30.0 * (i == 0 ? 43.0 : 10.0);
    // After the ramp the case is 600 s / (30 s/degC) (1 - exp(-ramp / 600 s)) behind and closes up to 0.2
    // degC; noise of the 30 s means and their length move that by up to 80 s.
    const double behind_degc = 20.0 * (1.0 - std::exp(-ramp_s / 600.0));
    EXPECT_NEAR(holds.used[i].from_s, begin_s + ramp_s + 600.0 * std::log(behind_degc / 0.2), 80.0);
    // The run is widest where it gives up some start for the end: on the next ramp the case has gone 0.2 degC
    // after sqrt(2 * 600 * 30 * 0.2) = 85 s, so the hold ends 0 to 85 s after the ramp's begin, give or take
    // a mean.
    EXPECT_NEAR(holds.used[i].to_s, begin_s + 4.5 * 3600.0 + 42.0, 43.0 + 30.0);
  }
}

// Read off at the end, the coldest soak would be 60 mHz wrong; fitted it is right within its standard error.
TEST_F(SevenSoaks, SettledValuesAreFittedNotReadOff) {
  const Instrument instrument;
  const auto stretches = record(2);
  const auto fit = fit_thermal(stretches);
  const auto settled =
      fit_settled(stretches, find_holds(stretches).used, fit.polynomial, fit.time_constant_s, fit.lag_s);
  ASSERT_EQ(settled.values.size(), 7U);
  for (const SettledValue& value : settled.values) {
    const double truth = true_hz(instrument, value.hold.case_degc);
    const double error_hz = std::hypot(value.frequency_error_hz, 0.43 * value.hold.case_error_degc);
    EXPECT_NEAR(value.frequency_hz, truth, 4.0 * error_hz);
    EXPECT_LT(error_hz, 2e-4);
    EXPECT_GT(std::abs(value.to_go_hz), 20.0 * error_hz);
  }
  EXPECT_EQ(study_order(settled.points()).chosen, 3);
}

TEST_F(SevenSoaks, SoaksThatTheFitHasNotSeen) {
  const auto stretches = record(3);
  const auto errors = leave_one_soak_out(stretches, find_holds(stretches).used, 3, 0.0);
  ASSERT_EQ(errors.size(), 7U);
  int ends = 0;
  for (const SoakError& error : errors) {
    EXPECT_LE(std::abs(error.error_degc), 0.02) << error.case_degc;
    ends += error.end ? 1 : 0;
  }
  EXPECT_EQ(ends, 2);
}

// A thermometer that reads 0.01 degC steps without noise to dither them: its error is stated, not hidden.
TEST_F(SevenSoaks, ThermometerWithoutDither) {
  Instrument instrument;
  instrument.case_noise_degc = 0.0;
  instrument.case_step_degc = 0.05;
  const auto holds = find_holds(record(4, instrument));
  ASSERT_EQ(holds.used.size(), 7U);
  for (const Hold& hold : holds.used) EXPECT_GT(hold.case_error_degc, 0.05 / std::sqrt(12.0) * 0.9);
}

TEST_F(SevenSoaks, RowsThatAreMissing) {
  auto stretches = record(5);
  for (Eigen::Index i = 20000; i < 26000; ++i) stretches[0].frequency_hz[i] = std::nan("");
  const auto fit = fit_thermal(stretches);
  EXPECT_NEAR(fit.time_constant_s, 2600.0, 5.0 * fit.time_constant_error_s);
}

TEST_F(SevenSoaks, SeveralRecordings) {
  const Instrument instrument;
  std::vector<ThermalStretch> stretches;
  for (int i = 0; i < 3; ++i) {
    const testing::Targets targets = {{0.0, -15.0 + 20.0 * i}};
    stretches.push_back(
        chamber_recording(instrument, targets, 4 * 3600.0, 60 + static_cast<std::uint64_t>(i)).stretch());
  }
  const auto fit = fit_thermal(stretches);
  EXPECT_NEAR(fit.time_constant_s, 2600.0, 5.0 * fit.time_constant_error_s);
  EXPECT_LT(fit.time_constant_error_s, 1.0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(fit.start_degc[i], 23.0, 0.02);
}

TEST(ThermalFit, KnownPolynomialLeavesTheTimeConstant) {
  const Instrument instrument;
  const std::vector<ThermalStretch> stretches = {
      chamber_recording(instrument, {{0.0, -20.0}}, 5 * 3600.0, 7).stretch()};
  const auto c = Eigen::VectorXd::Map(instrument.coefficients_hz.data(), 4);
  ThermalOptions options;
  options.known = FrequencyPolynomial(c, 0.0, -25.0, 45.0);
  const auto fit = fit_thermal(stretches, options);
  EXPECT_NEAR(fit.time_constant_s, 2600.0, 5.0 * fit.time_constant_error_s);
  EXPECT_LT(fit.time_constant_error_s, 2.0);
}

TEST(ThermalFit, NothingToSee) {
  const Instrument instrument;
  const std::vector<ThermalStretch> stretches = {
      chamber_recording(instrument, {{0.0, 23.0}}, 7200.0, 8).stretch()};
  EXPECT_THROW(fit_thermal(stretches), std::invalid_argument);
}

TEST(Holds, TooShort) {
  // 900 s at rest where 1500 s are asked for, then a jump and a creep.
  ThermalStretch stretch;
  stretch.time_s = Eigen::VectorXd::LinSpaced(6000, 0.0, 5999.0);
  stretch.frequency_hz = Eigen::VectorXd::Constant(6000, 4425.0);
  stretch.case_degc = Eigen::VectorXd::Constant(6000, 20.0);
  for (Eigen::Index i = 900; i < 6000; ++i)
    stretch.case_degc[i] = i < 1500 ? 20.0 + 0.01 * static_cast<double>(i - 900)
                                    : 26.0 + 0.8 / 4500.0 * static_cast<double>(i - 1500);
  const Holds holds = find_holds({stretch}, {0.2, 1.0, 1500.0});
  EXPECT_TRUE(holds.used.empty());
  bool too_short = false;
  for (const RefusedHold& hold : holds.refused) {
    too_short = too_short || hold.why.find("it lasts") != std::string::npos;
  }
  EXPECT_TRUE(too_short);
}

// Block means of an autoregression, summed term by term.
TEST(ThermalFilter, NoiseBehindTheFilter) {
  constexpr double step_s = 2.0, tau_s = 50.0;
  constexpr int length = 7;
  const double a = std::exp(-step_s / tau_s);
  const auto r = filtered_noise(4, length, step_s, tau_s);
  double whole[4] = {};
  for (int lag = 0; lag < 4; ++lag)
    for (int i = 0; i < length; ++i)
      for (int j = 0; j < length; ++j) whole[lag] += std::pow(a, std::abs(lag * length + j - i));
  for (int lag = 0; lag < 4; ++lag) EXPECT_NEAR(r[lag], whole[lag] / whole[0], 1e-12);
}

}  // namespace
}  // namespace hemi::calibration

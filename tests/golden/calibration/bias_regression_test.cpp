// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/bias_regression.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <random>

#include "tests/golden/calibration/thermal_recording.hpp"

namespace hemi::calibration {
namespace {

using testing::fill_rate;
using testing::kReferenceHz;
using testing::Profile;
using testing::scaled_truth;
using testing::thermal_recording;
using testing::Truth;

TEST(DriftTerms, AreTheTenMonomialsOfEquation21) {
  const Eigen::MatrixXd design =
      drift_design(Eigen::VectorXd::Constant(1, 2.0), Eigen::VectorXd::Constant(1, 3.0));
  const Eigen::RowVectorXd expected = (Eigen::RowVectorXd(10) << 1, 2, 4, 8, 3, 9, 27, 6, 12, 18).finished();
  EXPECT_EQ(design, expected);
  const std::vector<std::string_view> names = {"1",    "f",    "f^2",  "f^3",    "df",
                                               "df^2", "df^3", "f*df", "f^2*df", "f*df^2"};
  for (std::size_t i = 0; i < kDriftTermCount; ++i) EXPECT_EQ(kDriftTerms[i].name, names[i]);
}

// Noise far below the drift: the terms of Eq. (22) come back, and nothing else, in physical units.
TEST(BiasRegression, FindsEquation22WhereTheNoiseIsSmall) {
  DriftSamples samples = thermal_recording(2000, Profile::kCycle);
  const Truth truth =
      scaled_truth(samples, {{1, 1.0}, {2, -0.6}, {3, 0.5}, {4, -0.7}, {5, 0.4}, {6, 0.5}, {7, 0.6}}, 1e4);
  std::mt19937_64 generator(21);
  fill_rate(samples, truth, 0.9, generator);
  const BiasRegression fit = fit_bias(samples, kReferenceHz);
  for (std::size_t k = 0; k < kDriftTermCount; ++k)
    EXPECT_EQ(fit.selected(k), truth[k] != 0.0) << kDriftTerms[k].name;
  for (const SelectedTerm& term : fit.terms) {
    const boost::math::students_t distribution(term.dof);
    EXPECT_LT(std::abs(term.coefficient - truth[term.term]),
              boost::math::quantile(distribution, 1.0 - 1e-5) * term.standard_error)
        << kDriftTerms[term.term].name;
    EXPECT_TRUE(term.term == 0 || term.proven) << kDriftTerms[term.term].name;
  }
  EXPECT_NEAR(fit.noise.lag1_correlation(), std::pow(0.9, 1.5), 0.1);  // of averages of two
  EXPECT_EQ(fit.averaged, 2);
  EXPECT_NE(fit.report().find("enters"), std::string::npos);
}

// With white noise and a straight model the generalised fit is the ordinary one; predicted from its
// coefficients.
TEST(BiasRegression, PredictsFromPhysicalUnits) {
  DriftSamples samples = thermal_recording(500, Profile::kCycle);
  const Truth truth = scaled_truth(samples, {{1, 1.0}, {7, 0.6}}, 1e6);
  std::mt19937_64 generator(22);
  fill_rate(samples, truth, 0.0, generator);
  const BiasRegression fit = fit_bias(samples, kReferenceHz);
  for (Eigen::Index i = 0; i < 500; i += 7) {
    // Noise of one sample and the model's own error, of order 0.1: six of them.
    EXPECT_NEAR(fit.predict_dph(samples.frequency_hz(i), samples.slope_hz_per_s(i)), samples.rate_dph(i),
                6.0);
  }
}

// 95 % intervals of the true terms hold the truth: 300 recordings times three terms. Coverage of one kind of
// interval over 300 recordings has sigma 1.3 %; four of these.
TEST(BiasRegression, IntervalsHoldTheTruth) {
  DriftSamples samples = thermal_recording(1000, Profile::kCycle);
  const Truth truth = scaled_truth(samples, {{1, 1.0}, {4, -0.7}}, 100.0);
  std::mt19937_64 generator(23);
  constexpr int kRecordings = 300;
  std::array<int, kDriftTermCount> held{};
  std::array<int, kDriftTermCount> seen{};
  for (int recording = 0; recording < kRecordings; ++recording) {
    fill_rate(samples, truth, 0.9, generator);
    const BiasRegression fit = fit_bias(samples, kReferenceHz);
    for (const SelectedTerm& term : fit.terms) {
      if (truth[term.term] == 0.0) continue;
      const double bound = boost::math::quantile(boost::math::students_t(term.dof), 0.975);
      ++seen[term.term];
      held[term.term] += std::abs(term.coefficient - truth[term.term]) <= bound * term.standard_error ? 1 : 0;
    }
  }
  for (const std::size_t term : {0u, 1u, 4u}) {
    const double share = held[term] / static_cast<double>(seen[term]);
    std::printf("%-3s found in %d of %d, 95 %% interval holds the truth in %.1f %%\n",
                std::string(kDriftTerms[term].name).c_str(), seen[term], kRecordings, 100.0 * share);
    EXPECT_EQ(seen[term], kRecordings);
    EXPECT_NEAR(share, 0.95, 4.0 * std::sqrt(0.95 * 0.05 / kRecordings));
  }
}

// Two recordings fitted together: a jump between them is no drift and no noise of the sampled kind.
TEST(BiasRegression, SegmentsAreIndependent) {
  DriftSamples samples = thermal_recording(900, Profile::kCycle);
  const Truth truth = scaled_truth(samples, {{1, 1.0}, {4, 0.5}}, 300.0);
  std::mt19937_64 generator(24);
  fill_rate(samples, truth, 0.9, generator);
  samples.segments = {{0, 300}, {330, 5}, {400, 500}};
  samples.rate_dph.segment(300, 30).setConstant(1e9);
  samples.rate_dph(350) = std::nan("");
  const BiasRegression fit = fit_bias(samples, kReferenceHz);
  EXPECT_EQ(fit.rows, 805);
  EXPECT_TRUE(fit.selected(1));
  EXPECT_TRUE(fit.selected(4));
}

// A soak has no slope: what cannot be determined is said, the rest is fitted.
TEST(BiasRegression, UndeterminedTermsAreNamed) {
  DriftSamples samples = thermal_recording(400, Profile::kCycle);
  samples.slope_hz_per_s.setZero();
  const Truth truth = scaled_truth(thermal_recording(400, Profile::kCycle), {{1, 1.0}}, 100.0);
  std::mt19937_64 generator(25);
  fill_rate(samples, truth, 0.5, generator);
  const BiasRegression fit = fit_bias(samples, kReferenceHz);
  EXPECT_EQ(fit.undetermined, (std::vector<std::size_t>{4, 5, 6, 7, 8, 9}));
  EXPECT_TRUE(fit.selected(1));
  EXPECT_NE(fit.report().find("not determined"), std::string::npos);
}

TEST(BiasRegression, RefusesWhatItCannotFit) {
  DriftSamples samples = thermal_recording(100, Profile::kCooling);
  samples.segments = {{0, 101}};
  EXPECT_THROW(fit_bias(samples, kReferenceHz), std::invalid_argument);
  samples.segments = {{0, 30}};
  EXPECT_THROW(fit_bias(samples, kReferenceHz), std::invalid_argument);
  samples.segments = {{0, 100}};
  samples.rate_dph(3) = std::nan("");
  EXPECT_THROW(fit_bias(samples, kReferenceHz), std::invalid_argument);
  samples.rate_dph(3) = 0.0;
  EXPECT_THROW(fit_bias(samples, kReferenceHz, {.family_wise_level = 1.0}), std::invalid_argument);
  samples.rate_dph.resize(4);
  EXPECT_THROW(fit_bias(samples, kReferenceHz), std::invalid_argument);
}

}  // namespace
}  // namespace hemi::calibration

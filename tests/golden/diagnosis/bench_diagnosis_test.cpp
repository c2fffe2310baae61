// SPDX-License-Identifier: Apache-2.0
// Recordings of an independent writer, each with one thing left out of the linear model, or nothing.
#include "golden/diagnosis/bench_diagnosis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/golden/diagnosis/bench_writer.hpp"

namespace hemi::diagnosis {
namespace {

using testing::BenchWriter;

BenchDiagnosis diagnose(const BenchWriter& writer, const std::optional<BenchPrior>& prior = std::nullopt) {
  const auto written = writer.write();
  return diagnose_bench({written.force_v, written.displacement_v}, std::nullopt, writer.rate_hz, prior, {});
}

BenchPrior prior_of(const BenchWriter& writer) {
  return {{}, Eigen::Vector4d(writer.gain, writer.damping_per_s, writer.stiffness_per_s2, writer.constant)};
}

// One effect alone: named, nothing beside it, its interval of twice the 95 % width (6e-5 of chance) on the
// truth.
void expect_named(const BenchDiagnosis& result, Term term, double strength) {
  EXPECT_EQ(result.verdict, Verdict::named);
  ASSERT_EQ(result.named.size(), 1U);
  EXPECT_EQ(result.named[0].term, term);
  EXPECT_NEAR(result.named[0].strength, strength, 2.0 * result.named[0].half_width95);
  EXPECT_LT(result.named[0].half_width95, 0.5 * strength);
  EXPECT_GT(result.held_out.low, 0.0);
  // Noise is all that is left: 200 uV, correlated over 19 samples, so known to 1 / sqrt(2 x 8192 / 9.5) = 2.4
  // %.
  EXPECT_NEAR(result.final.rms(), 2e-4, 4.0 * 0.024 * 2e-4);
}

TEST(BenchDiagnosis, NothingLeftOut) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    BenchWriter writer;
    writer.seed = seed;
    const auto result = diagnose(writer, prior_of(writer));
    EXPECT_EQ(result.verdict, Verdict::consistent) << "seed " << seed;
    EXPECT_EQ(result.hold, Hold::band_limited);
    // About 60 decoys, each against the 1 % of the largest of eleven: two by chance in one recording of 500.
    EXPECT_LE(result.decoys_accepted, 1U);
  }
}

TEST(BenchDiagnosis, WrongNumbersAreRecalibrated) {
  BenchWriter writer;
  BenchPrior prior = prior_of(writer);
  prior.parameters[kDamping] *= 1.05;
  prior.parameters[kConstant] = 0.0;
  const auto result = diagnose(writer, prior);
  EXPECT_EQ(result.verdict, Verdict::recalibrate);
  for (const Eigen::Index place : {kGain, kDamping, kStiffness, kConstant})
    EXPECT_NEAR(result.final.parameters[place], prior_of(writer).parameters[place],
                2.0 * result.final.half_width95(place, 40));
}

TEST(BenchDiagnosis, CubicStiffness) {
  BenchWriter writer;
  writer.extra = [](double y, double) { return 7e5 * y * y * y; };
  expect_named(diagnose(writer), Term::stiffness_cubic, 7e5);
}

TEST(BenchDiagnosis, QuadraticStiffness) {
  BenchWriter writer;
  writer.extra = [](double y, double) { return 3e4 * y * y; };
  expect_named(diagnose(writer), Term::stiffness_square, 3e4);
}

TEST(BenchDiagnosis, QuadraticDamping) {
  BenchWriter writer;
  writer.extra = [](double, double v) { return 0.4 * v * std::abs(v); };
  expect_named(diagnose(writer), Term::damping_quadratic, 0.4);
}

// A force that no effect of the catalogue stands for; the cubic stiffness next to it is not named in its
// place.
TEST(BenchDiagnosis, ForceOutsideTheCatalogue) {
  BenchWriter writer;
  writer.extra = [](double y, double) { return 4e4 * y * std::abs(y); };
  const auto result = diagnose(writer);
  EXPECT_EQ(result.verdict, Verdict::unknown);
  EXPECT_TRUE(result.named.empty());
}

// A tenth of what can be detected stays without a name, and below the limit that is printed.
TEST(BenchDiagnosis, BelowTheLimit) {
  BenchWriter writer;
  const auto nothing = diagnose(writer);
  double limit = 0.0;
  for (const Limit& each : nothing.limits) limit = each.term == Term::stiffness_cubic ? each.smallest : limit;
  ASSERT_GT(limit, 0.0);
  writer.extra = [limit](double y, double) { return 0.1 * limit * y * y * y; };
  EXPECT_EQ(diagnose(writer).verdict, Verdict::consistent);
}

}  // namespace
}  // namespace hemi::diagnosis

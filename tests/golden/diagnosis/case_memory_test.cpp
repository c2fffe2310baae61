// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/case_memory.hpp"

#include <gtest/gtest.h>

#include "tests/golden/diagnosis/case_recording.hpp"

namespace hemi::diagnosis {
namespace {

void print(const char* what, const CaseMemory& result) {
  std::printf("%s: %s; left out %.3f -> %.3f deg/h; decoys not beaten %zu of %zu\n", what,
              std::string(name(result.verdict)).c_str(), result.held_out.before_rms,
              result.held_out.after_rms, result.decoys_accepted, result.decoy_rms_dph.size());
  for (const auto& family : result.families)
    std::printf("  %-22s %.3f%s\n", std::string(name(family.family)).c_str(), family.to_best.before_rms,
                family.beaten ? " beaten" : "");
}

TEST(MemoryColumns, NodeLagsARampByRateTimesTimeConstant) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(4001, 0.0, 4000.0);
  const double rate = 0.01, tau = 250.0;
  const Eigen::VectorXd degc = rate * time;
  const Eigen::VectorXd lag = degc - node_degc(time, degc, tau);
  const Eigen::ArrayXd exact = rate * tau * (1.0 - (-time.array() / tau).exp());
  // Each step holds its end value: early by up to one step of the ramp.
  EXPECT_LT((lag.array() - exact).abs().maxCoeff(), rate);
}

TEST(MemoryColumns, PlayKeepsItsThresholdAndForgetsNoSpeed) {
  Eigen::VectorXd degc(401);
  for (Eigen::Index i = 0; i <= 400; ++i)
    degc[i] = i <= 200 ? 0.1 * static_cast<double>(i) : 40.0 - 0.1 * static_cast<double>(i);
  const Eigen::VectorXd play = play_degc(degc, 3.0);
  EXPECT_DOUBLE_EQ(play[20], 0.0);
  EXPECT_NEAR(degc[200] - play[200], 3.0, 1e-12);
  EXPECT_NEAR(play[230], play[200], 1e-12);
  EXPECT_NEAR(degc[400] - play[400], -3.0, 1e-12);
  // The same temperatures at half the speed: the same play.
  Eigen::VectorXd slow(801);
  for (Eigen::Index i = 0; i <= 800; ++i)
    slow[i] = i % 2 == 0 ? degc[i / 2] : 0.5 * (degc[i / 2] + degc[i / 2 + 1]);
  EXPECT_NEAR(play_degc(slow, 3.0)[800], play[400], 1e-12);
}

TEST(CaseMemory, RampIsOneWayAndCycleIsNot) {
  EXPECT_LT(share_both_ways(one_ramp(1)), 0.05);
  EXPECT_GT(share_both_ways(three_speeds(1)), 0.9);
}

TEST(CaseMemory, NothingLeftOutIsConsistent) {
  CaseRows rows = three_speeds(1);
  add_baseline(rows, 2.0, 1);
  const CaseMemory result = diagnose_case(rows);
  print("null", result);
  EXPECT_EQ(result.verdict, Verdict::consistent);
  EXPECT_TRUE(result.named.empty());
  EXPECT_EQ(result.limits.size(), 11U);
  for (const auto& limit : result.limits) EXPECT_GT(limit.smallest[0].value, 0.0);
}

TEST(CaseMemory, LagIsNamedAndNothingElse) {
  CaseRows rows = three_speeds(2);
  add_baseline(rows, 1.0, 2);
  add_lag(rows, 1.5, 1100.0);
  const CaseMemory result = diagnose_case(rows);
  print("lag", result);
  EXPECT_EQ(result.verdict, Verdict::named);
  ASSERT_EQ(result.named.size(), 1U);
  EXPECT_EQ(result.named[0].memory, Memory::lag);
  EXPECT_LT(result.held_out.after_rms, 0.5 * result.held_out.before_rms);
}

TEST(CaseMemory, HysteresisOverThreeSpeedsIsNamedAndNothingElse) {
  CaseRows rows = three_speeds(3);
  add_baseline(rows, 1.0, 3);
  add_hysteresis(rows, 20.0);
  const CaseMemory result = diagnose_case(rows);
  print("hysteresis", result);
  EXPECT_EQ(result.verdict, Verdict::named);
  ASSERT_EQ(result.named.size(), 1U);
  EXPECT_EQ(result.named[0].memory, Memory::hysteresis);
  // In the middle of the range 32 of the 145 relays can be either way: 2 x 20 x 32 / 145 deg/h.
  const MemoryParameter& height = result.named[0].parameters[0];
  std::printf("  loop height %.1f +- %.1f deg/h\n", height.value, height.half_width95);
  EXPECT_NEAR(height.value, 8.83, height.half_width95);
}

// A lag far above the noise on one ramp at one speed, which a polynomial can follow.
TEST(CaseMemory, OneRampNamesNothing) {
  CaseRows rows = one_ramp(4);
  add_baseline(rows, 1.0, 4);
  add_lag(rows, 5.0, 1500.0);
  const CaseMemory result = diagnose_case(rows);
  print("one ramp", result);
  EXPECT_TRUE(result.named.empty());
  EXPECT_TRUE(result.verdict == Verdict::consistent || result.verdict == Verdict::ambiguous);
}

TEST(CaseMemory, RefusesTooLittle) {
  CaseRows rows = chamber({{0, 0}, {1000, 10}}, 1);
  EXPECT_THROW(diagnose_case(rows), std::invalid_argument);
  rows = three_speeds(1);
  rows.case_degc.setConstant(20.0);
  EXPECT_THROW(diagnose_case(rows), std::invalid_argument);
}

}  // namespace
}  // namespace hemi::diagnosis

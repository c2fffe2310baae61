// SPDX-License-Identifier: Apache-2.0
// A real driven resonator, which is not part of the source: skipped where absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "golden/diagnosis/bench_diagnosis.hpp"

namespace hemi::diagnosis {
namespace {

constexpr double kRateHz = 610.3515625;

std::filesystem::path recording() {
  const char* const shared = std::getenv("HEMI_SHARED");
  const std::filesystem::path root = shared != nullptr
                                         ? std::filesystem::path(shared)
                                         : std::filesystem::path(HEMI_SOURCE_DIR) / ".." / "shared";
  return root / "recordings" / "real" / "silverbox.csv";
}

BenchPart rows(Eigen::Index from, Eigen::Index to) {
  std::ifstream file(recording());
  std::string line;
  std::getline(file, line);
  BenchPart part{Eigen::VectorXd(to - from), Eigen::VectorXd(to - from)};
  for (Eigen::Index row = 0; row < to && std::getline(file, line); ++row) {
    double time = 0.0, force = 0.0, displacement = 0.0;
    char comma = ',';
    std::istringstream(line) >> time >> comma >> force >> comma >> displacement;
    if (row < from) continue;
    part.force_v[row - from] = force;
    part.displacement_v[row - from] = displacement;
  }
  return part;
}

// Named from the multisines alone; the growing amplitude is only predicted.
TEST(Silverbox, CubicStiffnessAndNothingWrong) {
  if (!std::filesystem::exists(recording())) GTEST_SKIP() << "recordings are not here; set HEMI_SHARED";
  const BenchDiagnosis result =
      diagnose_bench(rows(41000, 131072), rows(100, 40400), kRateHz, std::nullopt, {});
  EXPECT_EQ(result.verdict, Verdict::named);
  ASSERT_FALSE(result.named.empty());
  EXPECT_EQ(result.named[0].term, Term::stiffness_cubic);
  EXPECT_GT(result.named[0].strength, 0.0);
  for (const NamedTerm& named : result.named)
    EXPECT_TRUE(named.term == Term::stiffness_cubic || named.term == Term::stiffness_square);
  ASSERT_TRUE(result.other_part.has_value());
  std::printf("growing amplitude: %.4f -> %.4f mV\n", 1e3 * result.other_part->before_rms,
              1e3 * result.other_part->after_rms);
  EXPECT_LE(result.other_part->after_rms, 0.46e-3);
  EXPECT_LT(result.final.parameters[kConstant] + result.final.half_width95(kConstant, 40), 0.0);
  const auto& trials = result.steps.front().trials;
  for (const Term rival : {Term::stiffness_modulus, Term::damping_cubic}) {
    const auto found = std::ranges::find(trials, rival, &TermTrial::term);
    ASSERT_NE(found, trials.end());
    EXPECT_FALSE(found->reason.empty());
    EXPECT_GT(found->gain.after_rms, 2.0 * result.held_out.after_rms) << info(rival).shape;
  }
}

}  // namespace
}  // namespace hemi::diagnosis

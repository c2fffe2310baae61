// SPDX-License-Identifier: Apache-2.0
// On what the methods assume (white noise, the true form in the library) they work; what they do elsewhere is
// for `hemi prove` to show.
#include "golden/rivals/methods.hpp"

#include <gtest/gtest.h>

#include <random>

#include "golden/rivals/regression.hpp"

namespace hemi::rivals {
namespace {

/// A channel with base {1, x}, candidates "square" and "wave", misfit = share of each + white noise.
Problem channel(double square, double wave, unsigned seed) {
  constexpr Eigen::Index kRows = 1500;
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  Problem problem;
  problem.channel = "frequency_hz";
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(kRows, -1.0, 1.0);
  problem.base.resize(kRows, 2);
  problem.base << Eigen::VectorXd::Ones(kRows), x.matrix();
  problem.candidates = {{"square", x.square().matrix()}, {"wave", (9.0 * x).sin().matrix()}};
  problem.misfit = (3.0 + 2.0 * x + square * x.square() + wave * (9.0 * x).sin()).matrix();
  for (double& value : problem.misfit) value += normal(engine);
  problem.inputs = Eigen::MatrixXd::Ones(kRows, 9);
  problem.inputs.col(0) = x.matrix();
  return problem;
}

TEST(Stepwise, FindsWhatIsThereAndMostlyNothingElse) {
  int wrong = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Names names = stepwise({channel(1.0, 0.0, seed)});
    ASSERT_FALSE(names.empty());
    EXPECT_EQ(names.front(), "square");
    wrong += names.size() > 1 ? 1 : 0;
  }
  // BIC lets white noise in with probability P(chi2_1 > ln 1500) = 0.7 %: more than 3 of 40 in 2e-4 of all
  // runs.
  EXPECT_LE(wrong, 3);
}

TEST(Sparse, FindsWhatIsThere) {
  const Names names = sparse({channel(0.0, 1.0, 3)});
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "wave");
}

TEST(GaussianProcess, NamesTheInputThatMatters) {
  EXPECT_EQ(gaussian_process({channel(3.0, 0.0, 4)}), Names{"frequency_polynomial_order"});
  EXPECT_TRUE(gaussian_process({channel(0.0, 0.0, 5)}).empty());
}

TEST(Polynomial, SeesCurvatureInTemperature) {
  EXPECT_EQ(polynomial({channel(1.0, 0.0, 6)}), Names{"frequency_polynomial_order"});
}

TEST(FTest, AgreesWithTheTable) {
  // F(3, 10) = 3.708 is exceeded with probability 0.05.
  Regression part, full;
  part.rank = 2;
  full.rank = 5;
  full.squares = 10.0;
  part.squares = 10.0 + 3.0 * 3.708;
  EXPECT_NEAR(f_test(part, full, 15), 0.05, 2e-4);
}

TEST(Problems, RefuseARecordingWithoutTemperature) {
  Telemetry in;
  in.time_s = Eigen::VectorXd::LinSpaced(10, 0.0, 9.0);
  EXPECT_THROW(problems(in, {}, 2), std::invalid_argument);
}

}  // namespace
}  // namespace hemi::rivals

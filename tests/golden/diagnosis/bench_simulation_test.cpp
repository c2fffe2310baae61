// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/bench_simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "golden/diagnosis/equation_error.hpp"
#include "tests/golden/diagnosis/bench_writer.hpp"

namespace hemi::diagnosis {
namespace {

testing::BenchWriter quiet() {
  testing::BenchWriter writer;
  writer.noise_v = 0.0;
  writer.rows = 3000;
  return writer;
}

Eigen::VectorXd truth_of(const testing::BenchWriter& writer, const BenchForm& form) {
  Eigen::VectorXd p = Eigen::VectorXd::Zero(form.size());
  p.head(kLinear) << writer.gain, writer.damping_per_s, writer.stiffness_per_s2, writer.constant;
  return p;
}

// The phase runs away by 2e-6 a radian, of which 1 / d = 25 ms or 11 radians are remembered; the kernel's
// ripple is 1e-4 of the force.
TEST(BenchSimulation, FollowsAnotherIntegrator) {
  auto writer = quiet();
  writer.extra = [](double y, double) { return 7e5 * y * y * y; };
  const auto written = writer.write();
  const BenchForm form{{Term::stiffness_cubic}};
  Eigen::VectorXd p = truth_of(writer, form);
  p[kLinear] = 7e5;
  const BenchInput input(written.force_v, writer.rate_hz,
                         substeps_for(writer.stiffness_per_s2, writer.rate_hz), Hold::band_limited);
  const Eigen::VectorXd y = simulate(input, form, p);
  // The kernel needs 16 samples beyond either end, which are not there; their mark has decayed by e^-10 after
  // 0.5 s.
  const Eigen::VectorXd error = (y - written.displacement_v).segment(300, 2600);
  const double scale = std::sqrt(written.displacement_v.squaredNorm() / 3000.0);
  EXPECT_LT(std::sqrt(error.squaredNorm() / 2600.0), (11.0 * 2e-6 + 1e-4) * scale * std::sqrt(2.0));
}

// Central differences of step h are wrong by h^2 of the third derivative: 1e-4 steps leave 1e-6 of a column.
TEST(BenchSimulation, JacobianIsTheDerivative) {
  const auto writer = quiet();
  const auto written = writer.write();
  BenchForm form;
  for (const TermInfo& each : bench_terms()) form.terms.push_back(each.term);
  Eigen::VectorXd p = truth_of(writer, form);
  const double y = 0.1, v = 40.0, u = 0.03, force = 1e3;
  for (std::size_t j = 0; j < kTerms; ++j)
    p[kLinear + static_cast<Eigen::Index>(j)] = force / std::abs(shape(form.terms[j], y, v, u).value);
  p[form.start_row()] = 0.05;
  p[form.start_row() + 1] = 20.0;
  const BenchInput input(written.force_v, writer.rate_hz, 4, Hold::linear);
  Eigen::MatrixXd jacobian;
  simulate(input, form, p, jacobian);
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    Eigen::VectorXd up = p, down = p;
    const double h = 1e-4 * std::abs(p[i]);
    up[i] += h;
    down[i] -= h;
    const Eigen::VectorXd slope = (simulate(input, form, up) - simulate(input, form, down)) / (2.0 * h);
    EXPECT_LT((slope - jacobian.col(i)).norm(), 1e-5 * jacobian.col(i).norm()) << "parameter " << i;
  }
}

TEST(BenchSimulation, RunawayIsNotFinite) {
  const BenchForm form{{Term::stiffness_cubic}};
  Eigen::VectorXd p = truth_of(quiet(), form);
  p[kLinear] = -1e12;
  const BenchInput input(Eigen::VectorXd::Constant(2000, 1.0), 600.0, 4, Hold::zero_order);
  EXPECT_FALSE(simulate(input, form, p).allFinite());
}

// A staircase into a linear resonator has the exact answer y(t) = u b / k1 (1 - decay): its end is the static
// one.
TEST(BenchSimulation, StepSettlesOnStaticDeflection) {
  const BenchForm form;
  const auto writer = quiet();
  const Eigen::VectorXd p = truth_of(writer, form);
  const BenchInput input(Eigen::VectorXd::Constant(1000, 0.1), 600.0, 8, Hold::zero_order);
  const Eigen::VectorXd y = simulate(input, form, p);
  EXPECT_NEAR(y[999], (0.1 * writer.gain + writer.constant) / writer.stiffness_per_s2, 1e-12);
}

// Without noise the tapered derivatives are those of the record inside: what is left is the taper's leakage.
TEST(EquationError, FindsTheLinearResonator) {
  auto writer = quiet();
  const auto written = writer.write();
  const Eigen::Vector4d start = equation_error_start(written.force_v, written.displacement_v, writer.rate_hz);
  EXPECT_NEAR(start[kGain] / writer.gain, 1.0, 0.15);
  EXPECT_NEAR(start[kStiffness] / writer.stiffness_per_s2, 1.0, 0.15);
  EXPECT_NEAR(start[kDamping] / writer.damping_per_s, 1.0, 0.3);
}

}  // namespace
}  // namespace hemi::diagnosis

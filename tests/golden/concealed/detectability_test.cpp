// SPDX-License-Identifier: Apache-2.0
// d' against an experiment: the strength of a known trace is estimated from many noisy runs by generalised
// least squares; its scatter is 1 / d' of the trace.
#include "golden/concealed/detectability.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <numbers>

#include "golden/concealed/draw.hpp"
#include "golden/concealed/noise.hpp"

namespace hemi::concealed {
namespace {

constexpr Eigen::Index kBlock = 20;

Eigen::VectorXd block_means(const Series& values) {
  Eigen::VectorXd means(values.size() / kBlock);
  for (Eigen::Index b = 0; b < means.size(); ++b) means[b] = values.segment(b * kBlock, kBlock).mean();
  return means;
}

/// Covariance of block means by summing cosines over a fine grid of frequency, no Fourier transform involved.
Eigen::MatrixXd covariance(const NoiseLevel& level, Eigen::Index blocks) {
  Eigen::VectorXd lags = Eigen::VectorXd::Zero(blocks);
  constexpr double kGrid = 131072.0;
  for (double k = 1.0; k < 0.5 * kGrid; k += 1.0) {
    const double f = k / kGrid, x = std::numbers::pi * f;
    const double mean = std::sin(kBlock * x) / (kBlock * std::sin(x));
    const double power = density(level, f) * mean * mean / kGrid;
    if (power < 1e-12 * level.white * level.white) continue;
    // cos(m a) by Chebyshev's recurrence.
    const double step = std::cos(2.0 * x * kBlock);
    double before = step, now = 1.0;
    for (Eigen::Index m = 0; m < blocks; ++m) {
      lags[m] += power * now;
      const double next = 2.0 * step * now - before;
      before = now;
      now = next;
    }
  }
  Eigen::MatrixXd matrix(blocks, blocks);
  for (Eigen::Index i = 0; i < blocks; ++i)
    for (Eigen::Index j = 0; j < blocks; ++j) matrix(i, j) = lags[std::abs(i - j)];
  return matrix;
}

/// The ten bias terms and the constant of Eq. (21) over a run, block means.
Eigen::MatrixXd bias_columns(const Stand& stand) {
  const Series f = (stand.baseline.frequency_hz - stand.unit.model.reference_hz) / 10.0;
  const Series d = slope(stand.baseline.frequency_hz) / 3e-3;
  const std::vector<Series> terms{
      Series::Ones(f.size()), f, f.square(), f.cube(), d, d.square(), d.cube(), f * d, f.square() * d,
      f * d.square()};
  Eigen::MatrixXd columns(f.size() / kBlock, 10);
  for (std::size_t k = 0; k < terms.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k)) = block_means(terms[k]);
  return columns;
}

TEST(Detectability, IsTheInverseScatterOfAnEstimatedStrength) {
  Random random(21);
  Stand stand = random_stand(random, "multispeed", 0);
  stand.unit.noise[kRate] = NoiseLevel{0.6, 0.04, 0.0, 0.0, NoiseLevel::Shape::kGauss};
  stand.unit.noise[kFrequency] = NoiseLevel{2e-5, 0.0, 0.0, 0.0, NoiseLevel::Shape::kGauss};
  for (Series& series : stand.thermometer) series.setConstant(1e-12);  // the rate's own noise alone
  const Detectability limit = detectability(stand);
  const Form form = kind("thermal_gradient_bias").draw({random, stand.in, stand.unit.model, stand.baseline});
  const double offset = stand.unit.nuisance.start_offset_degc;
  const Trace trace = trace_of(simulate(stand.unit.model, stand.in, offset, {form.at(0.2)}), stand.baseline,
                               stand.unit.model, stand.in, offset);
  const double dprime = limit.dprime(trace);

  const Eigen::VectorXd shape = block_means(trace[kRate]);
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance(stand.unit.noise[kRate], shape.size()));
  Eigen::MatrixXd columns(shape.size(), 11);
  columns << bias_columns(stand), shape;
  const Eigen::MatrixXd white = factor.matrixL().solve(columns);
  const Eigen::MatrixXd inverse = (white.transpose() * white).inverse();
  // The polynomial and the time constant are held by the frequency, whose noise is 1e-4 of the effect's reach
  // in the rate: what they could still take over is below 3 %.
  EXPECT_NEAR(dprime * std::sqrt(inverse(10, 10)), 1.0, 0.03);

  constexpr int kRuns = 250;
  double squares = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Eigen::VectorXd noisy = block_means(noise(stand.unit.noise[kRate], trace[kRate].size(), random));
    const Eigen::VectorXd estimate = inverse * (white.transpose() * factor.matrixL().solve(noisy));
    squares += estimate[10] * estimate[10];
  }
  // Relative deviation of a standard deviation from 250 runs: 1 / sqrt(500); four of them, and the 3 % above.
  EXPECT_NEAR(std::sqrt(squares / kRuns) * dprime, 1.0, 4.0 / std::sqrt(2.0 * kRuns) + 0.03);
}

TEST(Detectability, SeesNothingInWhatTheNominalNumbersTakeOver) {
  Random random(22);
  const Stand stand = random_stand(random, "cycle", kTurn);
  const Detectability limit = detectability(stand);
  const double offset = stand.unit.nuisance.start_offset_degc;
  Model other = stand.unit.model;
  other.bias_dph[4] += 20.0;
  other.scale_factor += 1e-5;
  other.drive_v[0] += 1e-3;
  const Trace trace =
      trace_of(simulate(other, stand.in, offset), stand.baseline, stand.unit.model, stand.in, offset);
  EXPECT_GT(limit.raw(trace), 100.0);
  EXPECT_LT(limit.dprime(trace), 1e-3 * limit.raw(trace));
}

TEST(Detectability, SeesNothingOfHowWarmAPowerCutWas) {
  Random random(25);
  const Stand stand = random_stand(random, "multispeed", kPower);
  ASSERT_TRUE((stand.in.power == 0.0).any());
  const Detectability limit = detectability(stand);
  const double offset = stand.unit.nuisance.start_offset_degc;
  Excitation other = stand.in;
  other.case_ahead_degc -= 0.3 * (1.0 - stand.in.power);
  const Trace trace =
      trace_of(simulate(stand.unit.model, other, offset), stand.baseline, stand.unit.model, stand.in, offset);
  EXPECT_GT(limit.raw(trace), 1000.0);
  EXPECT_LT(limit.dprime(trace), 1e-3 * limit.raw(trace));
}

TEST(Detectability, CountsALineInWhiteNoiseExactly) {
  // A sine of amplitude a at 0.2 Hz over n samples of deviation s: d' = a sqrt(n / 2) / s; nothing of the
  // nominal model takes part of it.
  Random random(23);
  Stand stand = random_stand(random, "cycle", 0);
  stand.unit.noise[kQuadrature] = NoiseLevel{3e-4, 0.0, 0.0, 0.0, NoiseLevel::Shape::kGauss};
  stand.thermometer[kQuadrature].setConstant(1e-15);
  const Detectability limit = detectability(stand);
  Trace trace;
  for (Series& series : trace) series = Series::Zero(stand.in.time_s.size());
  trace[kQuadrature] = 2e-5 * (2.0 * std::numbers::pi * 0.2 * stand.in.time_s).sin();
  const double expected =
      2e-5 * std::sqrt(0.5 * static_cast<double>(stand.in.time_s.size())) / (3e-4 * std::sqrt(0.5));
  EXPECT_NEAR(limit.dprime(trace) / expected, 1.0, 2e-3);
}

TEST(Detectability, LeavesLittleOfTwoThatAreNearlyOne) {
  Random random(24);
  const Stand stand = random_stand(random, "cycle", 0);
  const Detectability limit = detectability(stand);
  Trace a, b;
  for (int output = 0; output < kOutputs; ++output)
    a[output] = b[output] = Series::Zero(stand.in.time_s.size());
  const Series wave = (stand.in.time_s / 700.0).sin();
  a[kRate] = wave;
  b[kRate] = 5.0 * wave;
  b[kDrive] = 1e-6 * wave;
  EXPECT_LT(limit.dprime_beside(a, b), 0.05 * limit.dprime(a));
  b[kRate] = (stand.in.time_s / 230.0).sin();
  EXPECT_GT(limit.dprime_beside(a, b), 0.95 * limit.dprime(a));
}

}  // namespace
}  // namespace hemi::concealed

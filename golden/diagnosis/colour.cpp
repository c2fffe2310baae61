// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/colour.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr Index kSlowBins = 60;

// Frequencies of the highest slow bins of whitened rows and between them and their neighbours, cycles a row.
std::vector<double> slow_lines(const VectorXd& white) {
  Eigen::FFT<double> fft;
  Eigen::VectorXcd spectrum;
  fft.fwd(spectrum, white);
  VectorXd power = spectrum.segment(1, std::min(kSlowBins, white.size() / 4)).cwiseAbs2();
  std::vector<double> list;
  for (int k = 0; k < 2; ++k) {
    Index at = 0;
    power.maxCoeff(&at);
    power[at] = 0.0;
    for (const double off : {-0.33, 0.0, 0.33})
      list.push_back((static_cast<double>(at + 1) + off) / static_cast<double>(white.size()));
  }
  return list;
}

MatrixXd with_wave(const MatrixXd& x, double cycles_a_row) {
  MatrixXd all(x.rows(), x.cols() + 2);
  const ArrayXd angle = 2.0 * std::numbers::pi * cycles_a_row *
                        ArrayXd::LinSpaced(x.rows(), 0.0, static_cast<double>(x.rows() - 1));
  all << x, angle.cos().matrix(), angle.sin().matrix();
  return orthonormal(all);
}

// The stated noise with one part more; and -2 log likelihood.
std::pair<double, NoiseShape> with_more(const MatrixXd& x, const VectorXd& y,
                                        const std::vector<Index>& blocks, const NoiseShape& stated,
                                        double NoiseShape::*part) {
  const auto shape = [&](double log_ratio) {
    NoiseShape more = stated;
    more.*part = std::max(stated.*part, stated.white * std::exp(log_ratio));
    return more;
  };
  const auto found = boost::math::tools::brent_find_minima(
      [&](double log_ratio) { return restricted_likelihood(x, y, blocks, shape(log_ratio), nullptr); }, -16.0,
      9.0, 12);
  NoiseShape best = shape(found.first);
  double scale = 1.0;
  restricted_likelihood(x, y, blocks, best, &scale);
  for (double NoiseShape::*each : {&NoiseShape::white, &NoiseShape::flicker, &NoiseShape::walk})
    best.*each *= scale;
  return {found.second, best};
}

// What the best slow sinusoid gains where the noise may have that colour beside it as well.
double line_gain(const MatrixXd& x, const VectorXd& y, const std::vector<Index>& blocks,
                 const NoiseShape& stated, double NoiseShape::*part, double without,
                 const NoiseShape& noise) {
  MatrixXd both(x.rows(), x.cols() + 1);
  both << x, y;
  const MatrixXd white = whiten(both, blocks, coloured_noise(noise, blocks.back() + 1));
  const MatrixXd own = white.leftCols(x.cols());
  const VectorXd e = white.rightCols(1);
  double best = without;
  for (const double line : slow_lines(e - own * (own.transpose() * own).ldlt().solve(own.transpose() * e)))
    best = std::min(best, with_more(with_wave(x, line), y, blocks, stated, part).first);
  return without - best - 3.0 * std::log(static_cast<double>(y.size()));
}

// Mean and relative deviation of the sample variance of rows that have this noise: for Gaussian rows with
// centred covariance C they are tr C / n and sqrt(2 tr C^2) / tr C.
std::pair<double, double> sample_variance(const ColouredNoise& noise, Index rows) {
  const Index n = std::min<Index>(rows, 240);
  const double stride = static_cast<double>(rows) / static_cast<double>(n);
  MatrixXd c(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      c(i, j) = noise.variance.dot(
          noise.correlation.array().pow(stride * static_cast<double>(std::abs(i - j))).matrix());
  c.rowwise() -= c.colwise().mean().eval();
  c.colwise() -= c.rowwise().mean().eval();
  if (c.trace() <= 0.0) return {0.0, 0.0};  // no such noise
  return {c.trace() / static_cast<double>(n), std::sqrt(2.0 * c.squaredNorm()) / c.trace()};
}

// Deviation of a variance's logarithm by the curvature of its likelihood, the white part fixed.
double log_deviation(const MatrixXd& x, const VectorXd& y, const std::vector<Index>& blocks, NoiseShape shape,
                     double NoiseShape::*part) {
  constexpr double kStep = 0.4;
  const double size = shape.*part;
  const auto at = [&](double step) {
    shape.*part = size * std::exp(step);
    double scale = 1.0;
    const double best_scaled = restricted_likelihood(x, y, blocks, shape, &scale);
    return best_scaled + static_cast<double>(y.size() - x.cols()) * (scale - std::log(scale));
  };
  const double curvature = (at(kStep) - 2.0 * at(0.0) + at(-kStep)) / (kStep * kStep);
  return std::sqrt(2.0 / std::max(curvature, 0.5));
}

}  // namespace

Colour colour_of(Hypotheses& hypotheses, const std::vector<Member>& members, const Reduced& beside,
                 Output output) {
  Colour colour;
  colour.output = output;
  const std::size_t c = place(output);
  const RowSpace& space = hypotheses.space();
  if (space.rows(output) < 64) return colour;
  const Reduced design = hypotheses.design(members);
  const MatrixXd x = orthonormal(joined({&design, &beside})[c]);
  const VectorXd y = hypotheses.data()[c].col(0);
  const auto& blocks = space.blocks(output);
  const NoiseShape stated = hypotheses.expected()[c];
  const double as_stated = restricted_likelihood(x, y, blocks, stated, nullptr);
  const auto [with_walk, walk] = with_more(x, y, blocks, stated, &NoiseShape::walk);
  const auto [with_flicker, flicker] = with_more(x, y, blocks, stated, &NoiseShape::flicker);
  colour.evidence = as_stated - std::min(with_walk, with_flicker);
  colour.walk_over_flicker = with_flicker - with_walk;
  if (colour.evidence <= 0.0) return colour;
  colour.line_gain = with_walk < with_flicker
                         ? line_gain(x, y, blocks, stated, &NoiseShape::walk, with_walk, walk)
                         : line_gain(x, y, blocks, stated, &NoiseShape::flicker, with_flicker, flicker);
  const double step_s = hypotheses.simulation().telemetry->step_s;
  // What is beyond the stated part.
  const double more_walk = walk.walk - stated.walk, more_flicker = flicker.flicker - stated.flicker;
  colour.walk = std::sqrt(std::max(more_walk, 0.0) / (static_cast<double>(space.block_rows()) * step_s));
  NoiseShape alone;
  alone.white = 0.0;
  alone.flicker = std::max(more_flicker, 0.0);
  const auto [variance, relative] =
      sample_variance(coloured_noise(alone, space.block_count()), space.block_count());
  // Within a block 1/f noise goes on: ln 6 of a decade of six holds `flicker`.
  const double within =
      alone.flicker / kFlickerPerProcess * std::log(std::max(1.0, static_cast<double>(space.block_rows())));
  colour.flicker = std::sqrt(variance + within);
  colour.flicker_rthz = std::sqrt(alone.flicker / kFlickerPerProcess);
  colour.log_deviation =
      with_walk < with_flicker
          ? 0.5 * log_deviation(x, y, blocks, walk, &NoiseShape::walk)
          : 0.5 * std::hypot(log_deviation(x, y, blocks, flicker, &NoiseShape::flicker), relative);
  return colour;
}

}  // namespace hemi::diagnosis

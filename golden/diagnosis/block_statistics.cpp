// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/block_statistics.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <complex>
#include <numeric>
#include <random>
#include <unsupported/Eigen/FFT>

#include "golden/calibration/autoregressive_noise.hpp"

namespace hemi::diagnosis {
namespace {

using calibration::RowRange;
constexpr int kResamples = 2000;
constexpr int kPermutations = 2000;
constexpr Eigen::Index kMostOrder = 12;

double quantile(std::vector<double> values, double share) {
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place), values.end());
  return values[place];
}

// Products of every block of the residual with every block of every column: one matrix (residual block,
// column block) a column.
std::vector<Eigen::MatrixXd> block_products(const Eigen::VectorXd& residual, const Eigen::MatrixXd& columns,
                                            Eigen::Index blocks) {
  const Eigen::Index length = residual.size() / blocks;
  const Eigen::Map<const Eigen::MatrixXd> e(residual.data(), length, blocks);
  std::vector<Eigen::MatrixXd> products;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const Eigen::Map<const Eigen::MatrixXd> s(columns.col(j).data(), length, blocks);
    products.push_back(e.transpose() * s);
  }
  return products;
}

}  // namespace

Gain bootstrap_gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                    const std::vector<RowRange>& blocks, std::uint64_t seed) {
  std::vector<double> squares_before, squares_after;
  for (const RowRange& block : blocks) {
    squares_before.push_back(before.segment(block.begin, block.count).squaredNorm());
    squares_after.push_back(after.segment(block.begin, block.count).squaredNorm());
  }
  const auto rows = static_cast<double>(calibration::total_rows(blocks));
  Gain gain{std::sqrt(std::accumulate(squares_before.begin(), squares_before.end(), 0.0) / rows),
            std::sqrt(std::accumulate(squares_after.begin(), squares_after.end(), 0.0) / rows)};
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> pick(0, blocks.size() - 1);
  std::vector<double> gains;
  for (int i = 0; i < kResamples; ++i) {
    double sum_before = 0.0, sum_after = 0.0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const std::size_t chosen = pick(random);
      sum_before += squares_before[chosen];
      sum_after += squares_after[chosen];
    }
    gains.push_back(std::sqrt(sum_before / rows) - std::sqrt(sum_after / rows));
  }
  gain.low = quantile(gains, 0.025);
  gain.high = quantile(gains, 0.975);
  return gain;
}

double share_won(const Eigen::VectorXd& best, const std::vector<Eigen::VectorXd>& others,
                 const std::vector<RowRange>& blocks, std::uint64_t seed) {
  // What each of the others leaves more than the best, a column, by blocks.
  Eigen::MatrixXd more(static_cast<Eigen::Index>(blocks.size()), static_cast<Eigen::Index>(others.size()));
  for (Eigen::Index b = 0; b < more.rows(); ++b) {
    const RowRange& block = blocks[static_cast<std::size_t>(b)];
    for (Eigen::Index j = 0; j < more.cols(); ++j)
      more(b, j) = others[static_cast<std::size_t>(j)].segment(block.begin, block.count).squaredNorm() -
                   best.segment(block.begin, block.count).squaredNorm();
  }
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<Eigen::Index> pick(0, more.rows() - 1);
  int won = 0;
  for (int i = 0; i < kResamples; ++i) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(more.cols());
    for (Eigen::Index b = 0; b < more.rows(); ++b) sum += more.row(pick(random));
    won += (sum.array() > 0.0).all() ? 1 : 0;
  }
  return (1.0 + won) / (2.0 + kResamples);
}

Eigen::VectorXd whitener_of(const Eigen::VectorXd& residual) {
  Eigen::MatrixXd beside_mean(residual.size(), 2);
  beside_mean.col(0).setConstant(1.0 / std::sqrt(static_cast<double>(residual.size())));
  beside_mean.col(1) = residual;
  const calibration::LaggedProducts products(beside_mean, {{0, residual.size()}}, kMostOrder);
  return calibration::fit_noise(products).partial;
}

MaxT max_t(const Eigen::VectorXd& residual, const Eigen::MatrixXd& model, const Eigen::MatrixXd& columns,
           Eigen::Index extra, const Eigen::VectorXd& partial, Eigen::Index blocks, std::uint64_t seed) {
  const Eigen::Index rows = residual.size() / blocks * blocks;
  Eigen::MatrixXd joined(residual.size(), model.cols() + columns.cols() + 1);
  joined << model, columns, residual;
  const Eigen::MatrixXd white = calibration::whiten(joined, {{0, residual.size()}}, partial).topRows(rows);
  const Eigen::MatrixXd own =
      white.leftCols(model.cols()) *
      white.leftCols(model.cols()).colwise().norm().cwiseMax(1e-300).cwiseInverse().asDiagonal();
  Eigen::MatrixXd rest = white.rightCols(columns.cols() + 1);
  rest -= own * (own.transpose() * own).ldlt().solve(own.transpose() * rest);
  const Eigen::VectorXd e = rest.col(columns.cols());
  const double sigma = std::sqrt(e.squaredNorm() / static_cast<double>(rows));
  MaxT result;
  result.norm = rest.leftCols(columns.cols()).colwise().norm().transpose() / sigma;
  const Eigen::MatrixXd unit =
      rest.leftCols(columns.cols()) * (sigma * result.norm).cwiseMax(1e-300).cwiseInverse().asDiagonal();
  result.overlap = unit.transpose() * unit;
  result.statistic = unit.transpose() * e / sigma;

  const Eigen::Index tested = columns.cols() - extra;
  const auto products = block_products(e, unit.leftCols(tested), blocks);
  std::mt19937_64 random(seed);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(blocks));
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> largest;
  for (int i = 0; i < kPermutations; ++i) {
    std::shuffle(order.begin(), order.end(), random);
    double most = 0.0;
    for (const auto& product : products) {
      double sum = 0.0;
      for (Eigen::Index b = 0; b < blocks; ++b) sum += product(order[static_cast<std::size_t>(b)], b);
      most = std::max(most, std::abs(sum) / sigma);
    }
    largest.push_back(most);
  }
  result.critical = quantile(largest, 1.0 - kFamilyWise);
  result.p = result.statistic.unaryExpr([&](double t) {
    const auto reached =
        std::count_if(largest.begin(), largest.end(), [&](double m) { return m >= std::abs(t); });
    return (1.0 + static_cast<double>(reached)) / (1.0 + kPermutations);
  });
  return result;
}

Eigen::VectorXd decoy_of(const Eigen::VectorXd& column, bool randomise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Eigen::Index n = column.size();
  Eigen::VectorXd copy(n);
  if (!randomise) {
    const Eigen::Index shift = std::uniform_int_distribution<Eigen::Index>(n / 10, n - n / 10)(random);
    copy << column.tail(n - shift), column.head(shift);
    return copy;
  }
  // A length of small factors; the tail beyond it keeps its own values turned round in time.
  Eigen::Index length = 1;
  while (2 * length <= n) length *= 2;
  Eigen::FFT<double> fft;
  Eigen::VectorXcd spectrum;
  Eigen::VectorXd part = column.head(length), turned;
  fft.fwd(spectrum, part);
  std::uniform_real_distribution<double> phase(0.0, boost::math::constants::two_pi<double>());
  for (Eigen::Index k = 1; 2 * k < length; ++k) {
    spectrum[k] = std::polar(std::abs(spectrum[k]), phase(random));
    spectrum[length - k] = std::conj(spectrum[k]);
  }
  fft.inv(turned, spectrum);
  copy << turned, column.tail(n - length).reverse();
  return copy;
}

}  // namespace hemi::diagnosis

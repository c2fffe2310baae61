// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hemi::prove {
namespace {

constexpr double kTwoSided95 = 1.959963984540054;  // quantile 0.975 of the normal distribution

double length(const Stretches& parts) {
  double sum = 0.0;
  for (const auto& [from, to] : parts) sum += to - from;
  return sum;
}

/// Sorted, overlapping ones joined.
Stretches merged(Stretches parts) {
  std::sort(parts.begin(), parts.end());
  Stretches result;
  for (const auto& part : parts) {
    if (!result.empty() && part.first <= result.back().second)
      result.back().second = std::max(result.back().second, part.second);
    else
      result.push_back(part);
  }
  return result;
}

}  // namespace

std::pair<double, double> wilson95(const Rate& rate) {
  if (rate.trials == 0) return {0.0, 1.0};
  const double n = rate.trials, p = rate.value(), z2 = kTwoSided95 * kTwoSided95;
  const double centre = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half = kTwoSided95 / (1.0 + z2 / n) * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n));
  return {std::max(centre - half, 0.0), std::min(centre + half, 1.0)};
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::pair<double, double> median_interval95(std::vector<double> values) {
  if (values.empty()) return {0.0, 0.0};
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size()), half = 0.5 * kTwoSided95 * std::sqrt(n);
  const auto low = static_cast<std::size_t>(std::max(std::floor(0.5 * n - half), 0.0));
  const auto high = static_cast<std::size_t>(std::min(std::ceil(0.5 * n + half), n - 1.0));
  return {values[low], values[high]};
}

Mean mean95(const std::vector<double>& values) {
  if (values.empty()) return {};
  const double n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / n;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double half = values.size() > 1 ? kTwoSided95 * std::sqrt(squares / (n - 1.0) / n) : 0.0;
  return {mean, mean - half, mean + half};
}

double calibration_error(const std::vector<std::pair<double, bool>>& stated) {
  struct Bin {
    double sum = 0.0;
    int right = 0, count = 0;
  };
  std::array<Bin, 10> bins;
  for (const auto& [probability, right] : stated) {
    Bin& bin = bins[static_cast<std::size_t>(std::clamp(std::floor(probability * 10.0), 0.0, 9.0))];
    bin.sum += probability;
    bin.right += right ? 1 : 0;
    ++bin.count;
  }
  double error = 0.0;
  for (const Bin& bin : bins)
    if (bin.count > 0) error += std::abs(bin.sum - bin.right);
  return stated.empty() ? 0.0 : error / static_cast<double>(stated.size());
}

double overlap(const Stretches& a, const Stretches& b) {
  const Stretches first = merged(a), second = merged(b);
  double common = 0.0;
  for (const auto& [from, to] : first)
    for (const auto& [other_from, other_to] : second)
      common += std::max(0.0, std::min(to, other_to) - std::max(from, other_from));
  const double either = length(first) + length(second) - common;
  return either > 0.0 ? common / either : 0.0;
}

}  // namespace hemi::prove

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

namespace hemi::concealed {

/// Everything that is drawn for one recording comes from one of these; the same key gives the same recording.
class Random {
 public:
  explicit Random(std::uint64_t key) : engine_(key) {}
  /// An own stream for recording `index` of a class: no two classes or seeds share numbers.
  Random(std::uint64_t seed, std::string_view name, std::uint64_t index) {
    std::vector<std::uint32_t> words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                                     static_cast<std::uint32_t>(index)};
    for (const char c : name) words.push_back(static_cast<unsigned char>(c));
    std::seed_seq sequence(words.begin(), words.end());
    engine_.seed(sequence);
  }

  double uniform(double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(engine_);
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0.0, 1.0)); }
  double normal() { return normal_(engine_); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  /// 0 .. count - 1.
  std::size_t index(std::size_t count) {
    return std::min(static_cast<std::size_t>(uniform(0.0, static_cast<double>(count))), count - 1);
  }
  template <typename T>
  const T& pick(const std::vector<T>& choices) {
    return choices[index(choices.size())];
  }
  /// Student's t of 5 degrees of freedom, scaled to unit variance.
  double heavy_tailed() {
    double chi_squared = 0.0;
    for (int i = 0; i < 5; ++i) {
      const double x = normal();
      chi_squared += x * x;
    }
    return normal() / std::sqrt(chi_squared / 5.0) * std::sqrt(3.0 / 5.0);
  }
  /// Double exponential of unit variance.
  double laplace() {
    const double u = uniform(-0.5, 0.5);
    return -std::copysign(std::log1p(-2.0 * std::abs(u) * (1.0 - 1e-15)), u) / std::sqrt(2.0);
  }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

}  // namespace hemi::concealed

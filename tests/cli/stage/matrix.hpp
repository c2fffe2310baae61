// SPDX-License-Identifier: Apache-2.0
// Concealed captures through the diagnosis, counted.
#ifndef HEMI_TESTS_CLI_STAGE_MATRIX_HPP
#define HEMI_TESTS_CLI_STAGE_MATRIX_HPP

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "tests/cli/stage/concealed.hpp"

namespace hemi::tests {

constexpr int stage_count = 7;

struct Score {
  int right = 0, total = 0;
  /// 95 % interval of the rate (Wilson, J. Am. Stat. Assoc. 22 (1927) 209).
  std::array<double, 2> wilson() const {
    const double n = total, p = right / n, z = 1.959963984540054, z2 = z * z;
    const double middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    const double half = z / (1.0 + z2 / n) * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n));
    return {middle - half, middle + half};
  }
};

struct Matrix {
  std::array<std::array<int, stage_count>, fault_count> count{};

  void run(Fault fault, double strength, std::uint64_t seed, double seconds) {
    const Concealed concealed = make_concealed(fault, strength, seed, seconds);
    diagnosis::StageDiagnosis diagnosis;
    try {
      diagnosis = diagnose(concealed.shown);
    } catch (const std::invalid_argument& refused) {
      // a capture that is refused says nothing of its stage
      fmt::print("refused: {}\n", refused.what());
    }
    ++count[static_cast<std::size_t>(fault)][static_cast<std::size_t>(diagnosis.stage)];
    if (diagnosis.stage == stage_of(fault)) return;
    fmt::print("seed {}: {}, {}: found {}", seed, name(fault), concealed.truth,
               diagnosis::name(diagnosis.stage));
    for (const auto& finding : diagnosis.findings)
      fmt::print("; {} (weight {:.3g})", finding.effect, finding.weight);
    fmt::print("\n");
    std::fflush(stdout);
  }

  Score score(bool faults_alone) const {
    Score score;
    for (int f = faults_alone ? 1 : 0; f < fault_count; ++f) {
      for (int s = 0; s < stage_count; ++s) {
        const int n = count[static_cast<std::size_t>(f)][static_cast<std::size_t>(s)];
        score.total += n;
        if (static_cast<int>(stage_of(static_cast<Fault>(f))) == s) score.right += n;
      }
    }
    return score;
  }

  void print() const {
    fmt::print("{:<22}", "concealed \\ found");
    for (int s = 0; s < stage_count; ++s)
      fmt::print("{:>14}", diagnosis::name(static_cast<diagnosis::Stage>(s)));
    fmt::print("\n");
    for (int f = 0; f < fault_count; ++f) {
      fmt::print("{:<22}", name(static_cast<Fault>(f)));
      for (const int n : count[static_cast<std::size_t>(f)]) fmt::print("{:>14}", n);
      fmt::print("\n");
    }
  }
};

}  // namespace hemi::tests

#endif  // HEMI_TESTS_CLI_STAGE_MATRIX_HPP

// SPDX-License-Identifier: Apache-2.0
#include "golden/chain/nco.hpp"

#include <array>
#include <numbers>

namespace hemi::golden {
namespace {

constexpr int kLines = 1 << config::table_index_bits;
constexpr int kAngleBits = 2 + config::table_index_bits + config::table_fine_bits;
constexpr double kPhaseSpan = 32.0;  // turns
constexpr double kScale = config::table_scale / 1048576.0;

struct QuarterWave {
  std::array<double, kLines + 1> base;
  QuarterWave() {
    for (int i = 0; i <= kLines; ++i) {
      base[static_cast<std::size_t>(i)] =
          round_to(config::table_scale * std::sin(std::numbers::pi / 2 * i / kLines), 0);
    }
  }
};

const QuarterWave& quarter_wave() {
  static const QuarterWave table;
  return table;
}

}  // namespace

double interpolated_sine(double angle) {
  const double half_turn = power_of_two(kAngleBits - 1);
  const bool negative = angle >= half_turn;
  const double in_half = negative ? angle - half_turn : angle;
  const double in_quarter =
      std::min(in_half, half_turn - 1.0 - in_half);  // the second quarter mirrors the first
  const double position = (in_quarter + 0.5) * power_of_two(-config::table_fine_bits);
  const auto line = static_cast<std::size_t>(position);
  const auto& base = quarter_wave().base;
  const double value = base[line] + (base[line + 1] - base[line]) * (position - static_cast<double>(line));
  const double magnitude = round_to(value * power_of_two(-20), config::sine.fraction);
  return negative ? 0.0 - magnitude : magnitude;
}

double nco_sine(const Arithmetic& arithmetic, double turns) {
  const double turn = turns - std::floor(turns);
  if (arithmetic.quantised()) return interpolated_sine(floor_to(turn, kAngleBits) * power_of_two(kAngleBits));
  return kScale * std::sin(2.0 * std::numbers::pi * turn);
}

void Nco::run(Eigen::Index count, Eigen::Ref<Eigen::ArrayXd> phase, Eigen::Ref<Eigen::ArrayXd> cosine,
              Eigen::Ref<Eigen::ArrayXd> sine) {
  // |phase| <= 16 and |increment| <= 1: up to the 16th sample of a piece the sum stays within 32 turns, which
  // is 2^53 steps of 2^-48, so that the sum is exact before it is wrapped.
  constexpr Eigen::Index kPiece = 16;
  for (Eigen::Index done = 0; done < count; done += kPiece) {
    const Eigen::Index size = std::min(kPiece, count - done);
    phase.segment(done, size) =
        (phase_ + increment_ * Eigen::ArrayXd::LinSpaced(size, 0.0, static_cast<double>(size - 1)))
            .unaryExpr([](double turns) { return modulo(turns, kPhaseSpan); });
    phase_ = modulo(phase_ + increment_ * static_cast<double>(size), kPhaseSpan);
  }
  const Eigen::ArrayXd turn = phase.head(count) - phase.head(count).floor();
  if (arithmetic_.quantised()) {
    const double full = power_of_two(kAngleBits);
    const Eigen::ArrayXd angle = (turn * full).floor();
    sine.head(count) = angle.unaryExpr([](double a) { return interpolated_sine(a); });
    cosine.head(count) = angle.unaryExpr([full](double a) {
      const double ahead = a + full / 4;
      return interpolated_sine(ahead < full ? ahead : ahead - full);
    });
  } else {
    sine.head(count) = kScale * (2.0 * std::numbers::pi * turn).sin();
    cosine.head(count) = kScale * (2.0 * std::numbers::pi * turn).cos();
  }
}

}  // namespace hemi::golden

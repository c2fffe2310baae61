// SPDX-License-Identifier: Apache-2.0
// Spurs of the quantised nco: by calculation, over every angle there is, and in the output for several
// increments.
#include "golden/chain/nco.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace hemi::golden {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLimitDbc = -115.0;

double decibels(double ratio) {
  return 20.0 * std::log10(ratio);
}

// The nco's sine over its 2^24 angles. For an increment of an odd number of angle steps its spectrum is that
// of this sequence with the lines in another order, so that the largest harmonic is the largest spur of all
// these increments. f(n + N/2) = -f(n): odd harmonics only, of which 4k + 1 come out of a quarter-length
// transform and 4k + 3 are the conjugates of N - (4k + 3).
double worst_harmonic_dbc() {
  constexpr Eigen::Index n = 1 << 24;
  constexpr Eigen::Index quarter = n / 4;
  Eigen::VectorXcd folded(quarter);
  for (Eigen::Index i = 0; i < quarter; ++i) {
    const std::complex<double> pair(interpolated_sine(static_cast<double>(i)),
                                    -interpolated_sine(static_cast<double>(i + quarter)));
    folded[i] = pair * std::polar(1.0, -2.0 * kPi * static_cast<double>(i) / static_cast<double>(n));
  }
  Eigen::FFT<double> fft;
  Eigen::VectorXcd lines;
  fft.fwd(lines, folded);
  const double carrier = std::abs(lines[0]);
  lines[0] = 0.0;
  return decibels(lines.cwiseAbs().maxCoeff() / carrier);
}

double worst_spur_dbc(double increment, Eigen::Index period) {
  Nco nco(Precision::quantised, increment);
  Eigen::ArrayXd phase(period);
  Eigen::ArrayXd cosine(period);
  Eigen::ArrayXd sine(period);
  nco.run(period, phase, cosine, sine);
  Eigen::FFT<double> fft;
  double worst = -400.0;
  for (const Eigen::ArrayXd& wave : {cosine, sine}) {
    Eigen::VectorXcd lines;
    fft.fwd(lines, wave.matrix().eval());
    Eigen::ArrayXd magnitude = lines.head(period / 2 + 1).cwiseAbs();
    const auto carrier_bin = static_cast<Eigen::Index>(std::lround(increment * static_cast<double>(period)));
    const double carrier = magnitude[carrier_bin];
    magnitude[carrier_bin] = 0.0;
    magnitude[0] /= 2.0;  // a line at zero is not split in two
    worst = std::max(worst, decibels(magnitude.maxCoeff() / carrier));
  }
  return worst;
}

TEST(Nco, SpursByCalculation) {
  // Chords: the error (h^2/2) t (1 - t) sin repeats with every line; its mean is amplitude, its first
  // harmonic (h^2 / 2) / pi^2 cos(2 pi t) makes two sidebands of half that at 2048 harmonics' distance.
  const double h = kPi / 2.0 / 512.0;
  const double chords = h * h / 2.0 / (kPi * kPi) / 2.0;
  // Angle floored to 2^-24 turn: the phase is a staircase, whose sidebands are carrier / (2^24 - 1) or less.
  const double truncation = power_of_two(-24);
  // All that roundings leave, lines and result together, in one single line: variance v against the carrier's
  // 1/2.
  const double rounding = std::sqrt((power_of_two(-40) * 2.0 / 3.0 + power_of_two(-38)) / 12.0 / 0.5);
  fmt::print(
      "spurs by calculation: chords {:.1f}, angle {:.1f}, roundings all in one line {:.1f}, sum {:.1f} dBc\n",
      decibels(chords), decibels(truncation), decibels(rounding), decibels(chords + truncation + rounding));
  EXPECT_LE(decibels(chords + truncation + rounding), kLimitDbc);
}

TEST(Nco, SpursOfEveryOddIncrement) {
  const double worst = worst_harmonic_dbc();
  fmt::print("worst of all harmonics over the 2^24 angles: {:.2f} dBc\n", worst);
  EXPECT_LE(worst, kLimitDbc);
}

TEST(Nco, SpursInItsOutputOverAFullPeriod) {
  struct Case {
    double numerator;
    int log2_period;
  };
  // Near 4425 Hz of 100 kHz and of 250 kHz; long and short periods, in which the errors gather in fewer
  // lines.
  double worst = -400.0;
  for (const Case& c :
       {Case{46399, 20}, Case{18559, 20}, Case{2899, 16}, Case{181, 12}, Case{1159, 16}, Case{45, 10}}) {
    const double spur =
        worst_spur_dbc(c.numerator * power_of_two(-c.log2_period), Eigen::Index{1} << c.log2_period);
    fmt::print("increment {:.0f} / 2^{}: worst spur {:.2f} dBc\n", c.numerator, c.log2_period, spur);
    worst = std::max(worst, spur);
  }
  fmt::print("worst spur {:.2f} dBc\n", worst);
  EXPECT_LE(worst, kLimitDbc);
}

TEST(Nco, SineStaysInItsFormatAndMirrors) {
  EXPECT_EQ(interpolated_sine(power_of_two(22) - 1.0), 1.0 - power_of_two(-19));
  EXPECT_EQ(interpolated_sine(power_of_two(22)), interpolated_sine(power_of_two(22) - 1.0));
  for (double angle = 0.0; angle < power_of_two(23); angle += 4099.0) {
    EXPECT_EQ(interpolated_sine(angle), interpolated_sine(power_of_two(23) - 1.0 - angle));
    EXPECT_EQ(interpolated_sine(angle + power_of_two(23)), -interpolated_sine(angle));
  }
}

TEST(Nco, PhaseIsExactForEveryIncrement) {
  // Whole numbers modulo 2^53 beside it: the largest increments carry 16 samples to just 2^53.
  for (const double increment : {1.0 - power_of_two(-48), -1.0, power_of_two(-48), -0.3 + 0.0, 4425e-5}) {
    const double on_grid = round_to(increment, 48);
    Nco nco(Precision::quantised, on_grid);
    Eigen::ArrayXd phase(50);
    Eigen::ArrayXd cosine(50);
    Eigen::ArrayXd sine(50);
    const auto step = static_cast<std::int64_t>(std::ldexp(on_grid, 48));
    std::uint64_t word = 0;
    for (int block = 0; block < 2000; ++block) {
      nco.run(50, phase, cosine, sine);
      for (Eigen::Index i = 0; i < 50; ++i, word += static_cast<std::uint64_t>(step)) {
        const std::int64_t wrapped = static_cast<std::int64_t>(word << 11) >> 11;
        ASSERT_EQ(std::ldexp(phase[i], 48), static_cast<double>(wrapped)) << on_grid << " sample " << i;
      }
    }
  }
}

}  // namespace
}  // namespace hemi::golden

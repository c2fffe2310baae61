// SPDX-License-Identifier: Apache-2.0
// What the fixed point adds to the noise: the core and the ideal chain on the same noise, and the variance of
// their difference.
#ifndef HEMI_TESTS_TB_PAIRED_NOISE_HPP
#define HEMI_TESTS_TB_PAIRED_NOISE_HPP

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <unsupported/Eigen/FFT>

#include "golden/chain/chain.hpp"
#include "golden/chain/modulator.hpp"
#include "tb/hls_engine.hpp"
#include "tb/registers.hpp"
#include "tests/tb/noise_bench.hpp"

namespace hemi::tests {

/// By how much the core's nco is smaller than the ideal one: the chords between the lines of its table lie
/// inside the arc by h^2/12 in the mean, h = pi/2/512 (golden/chain/budget.hpp).
inline constexpr double kTableShortfall = std::numbers::pi * std::numbers::pi / (1024.0 * 1024.0 * 12.0);

/// Registers as the core holds them.
inline golden::RegisterValues held_registers(const physics::Instrument& instrument, bool wide) {
  const auto image = tb::to_image(control_registers(instrument, wide));
  golden::RegisterValues values{};
  for (int i = 0; i < config::register_count; ++i)
    values[static_cast<std::size_t>(i)] =
        tb::to_value(image[static_cast<std::size_t>(i)], config::registers[i].format);
  return values;
}

/// The ideal chain behind the same DACs as the core's: 16 bit, error fed back. Plain rounding would put four
/// times the noise on the carrier, 0.024 deg/h/sqrt(Hz), which is none of the core's.
class IdealBehindDacs {
 public:
  explicit IdealBehindDacs(bool wide, const golden::RegisterValues& values)
      : chain_(golden::Precision::ideal,
               wide ? golden::InstrumentParameters::wide() : golden::InstrumentParameters::reference(),
               values) {}

  tb::DacWords step(const tb::SamplePair& sample, std::vector<tb::Record>& output) {
    records_.clear();
    const golden::DacWords words = chain_.step(sample.x, sample.y, sample.gap, records_);
    for (const auto& record : records_) output.push_back({record.words});
    return {raw(drive_(words.drive)), raw(rebalance_(words.rebalance)), raw(quadrature_(words.quadrature))};
  }

 private:
  static std::int32_t raw(double word) {
    return static_cast<std::int32_t>(std::ldexp(word, config::dac.fraction));
  }

  golden::Chain chain_;
  golden::ErrorFeedback drive_{golden::Precision::quantised};
  golden::ErrorFeedback rebalance_{golden::Precision::quantised};
  golden::ErrorFeedback quadrature_{golden::Precision::quantised};
  std::vector<golden::ChainRecord> records_;
};

/// Variance of a difference over the variance of the record itself.
struct Share {
  double overall = 0.0;
  double to_10_hz = 0.0;
};

struct FixedPointShares {
  Share rate;            ///< two plants, the same noise, each closed around its chain
  Share frequency;       ///< likewise
  Share heard;           ///< frequency of the ideal chain that listens to the core's ADC words
  double x_words = 0.0;  ///< mean square difference of the two plants' ADC words over the noise's square
  double y_words = 0.0;
};

/// Share of `difference` in `record`, from periodograms with a Hann window.
inline Share share(const Eigen::VectorXd& difference, const Eigen::VectorXd& record) {
  const auto n = record.size();
  Eigen::FFT<double> fft;
  const auto power = [&](const Eigen::VectorXd& signal) {
    const Eigen::ArrayXd turn = 2.0 * std::numbers::pi *
                                Eigen::ArrayXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5) /
                                static_cast<double>(n);
    const Eigen::VectorXd windowed = (signal.array() - signal.mean()) * (1.0 - turn.cos());
    Eigen::VectorXcd spectrum;
    fft.fwd(spectrum, windowed);
    return Eigen::VectorXd(spectrum.segment(1, n / 2).cwiseAbs2());
  };
  const Eigen::VectorXd of_difference = power(difference), of_record = power(record);
  const auto to_10_hz = static_cast<Eigen::Index>(10.0 * static_cast<double>(n) / config::output_rate_hz);
  return {of_difference.sum() / of_record.sum(),
          of_difference.head(to_10_hz).sum() / of_record.head(to_10_hz).sum()};
}

/// Runs core and ideal chain after kSettling_s. The ideal one's set point is smaller by the core's table, so
/// that both plants vibrate alike: 7.8e-7 more amplitude are 0.02 LSB at the ADC, and one sample in 85 would
/// be rounded to another code.
inline FixedPointShares fixed_point_shares(bool wide, double seconds, std::uint64_t seed) {
  const physics::Instrument instrument;
  const auto registers = held_registers(instrument, wide);
  auto matched = registers;
  matched[config::reg_amplitude_setpoint] *= 1.0 + kTableShortfall;

  ControlBench core(tb::make_hls_engine(wide), instrument, wide, {1.0, 2.0, 0.0, 0.0}, seed);
  IdealBehindDacs listener(wide, registers), ideal(wide, matched);
  physics::PlantConfiguration configuration;
  configuration.adc = wide ? physics::AdcConfiguration::wide() : physics::AdcConfiguration::reference();
  configuration.start = {1.0, 2.0, 0.0, 0.0};
  configuration.seed = seed;
  physics::Plant twin(instrument, instrument.at(20.0), configuration);

  const auto count = static_cast<Eigen::Index>(seconds * config::output_rate_hz);
  Eigen::MatrixXd rate(count, 2), frequency(count, 3);
  double x_squares = 0.0, y_squares = 0.0;
  const auto settling = static_cast<Eigen::Index>(kSettling_s * config::output_rate_hz);
  for (Eigen::Index i = -settling; i < count; ++i) {
    std::vector<tb::Record> heard, other;
    const auto both = [&](const tb::SamplePair& pair, const tb::DacWords&) {
      listener.step(pair, heard);
      tb::close_loop(ideal, twin, 1, other, tb::Untouched{},
                     [&](const tb::SamplePair& twins, const tb::DacWords&) {
                       if (i < 0) return;
                       x_squares += (twins.x - pair.x) * (twins.x - pair.x);
                       y_squares += (twins.y - pair.y) * (twins.y - pair.y);
                     });
    };
    const Reading r = core.run(1.0 / config::output_rate_hz, tb::Untouched{}, both).at(0);
    if (i < 0) continue;
    rate.row(i) << r.rate_dph, other.at(0).words[config::word_rate];
    frequency.row(i) << r.frequency_hz, other.at(0).words[config::word_frequency],
        heard.at(0).words[config::word_frequency];
  }

  const double rate_hz = wide ? config::Wide::adc_rate_hz : config::Reference::adc_rate_hz;
  const double codes = wide ? 1 << (config::Wide::adc_bits - 16) : 1.0;
  const double noise_codes = instrument.pickoff_noise_lsb * codes;
  const double square = noise_codes * noise_codes * rate_hz / config::Reference::adc_rate_hz + 1.0 / 12.0;
  const double samples = seconds * rate_hz;
  return {share(rate.col(0) - rate.col(1), rate.col(0)),
          share(frequency.col(0) - frequency.col(1), frequency.col(0)),
          share(frequency.col(0) - frequency.col(2), frequency.col(0)), x_squares / samples / square,
          y_squares / samples / square};
}

inline void print_shares(const char* name, const FixedPointShares& s) {
  std::printf(
      "%s: difference over record, variances    overall    to 10 Hz\n"
      "  rate, two plants                      %9.3g   %9.3g\n"
      "  frequency, two plants                 %9.3g   %9.3g\n"
      "  frequency, the same ADC words         %9.3g   %9.3g\n"
      "  ADC words of the two plants: x %.3g, y %.3g of the noise's square\n",
      name, s.rate.overall, s.rate.to_10_hz, s.frequency.overall, s.frequency.to_10_hz, s.heard.overall,
      s.heard.to_10_hz, s.x_words, s.y_words);
}

inline void expect_below(const FixedPointShares& s, double limit) {
  for (const Share& one : {s.rate, s.frequency, s.heard}) {
    EXPECT_LT(one.overall, limit);
    EXPECT_LT(one.to_10_hz, limit);
    // The two chains are two: what is compared with itself differs by nothing.
    EXPECT_GT(one.overall, 0.0);
  }
}

}  // namespace hemi::tests

#endif  // HEMI_TESTS_TB_PAIRED_NOISE_HPP

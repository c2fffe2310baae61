// SPDX-License-Identifier: Apache-2.0
#include "tests/golden/chain/support.hpp"

#include <bitset>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace hemi::golden::testing {

using namespace config;

RegisterValues reference_values(const InstrumentParameters& instrument, double start_hz) {
  const double wn = 2.0 * std::numbers::pi * 10.0 / 2.482;
  const double fs = instrument.adc_rate_hz;
  RegisterValues values{};
  values[reg_nco_start] = start_hz / fs;
  values[reg_loop_proportional] = 2.0 * wn / fs;
  values[reg_loop_integral] = wn * wn / (fs * fs / instrument.decimation);
  values[reg_loop_frequency] = 1.0 / (32.0 * instrument.decimation);
  values[reg_amplitude_threshold] = 0.001;
  values[reg_lock_count] = 1000.0;
  values[reg_demodulation_cos] = 1.0;
  values[reg_rate_gain] = 1.0;
  values[reg_frequency_reference] = 4425.0;
  values[reg_calibrated_low] = -1.0;
  values[reg_calibrated_high] = highest_of(offset);
  std::bitset<54> parity;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = round_to(values[i], registers[i].format.fraction);
    const double raw = values[i] * power_of_two(registers[i].format.fraction);
    parity ^= std::bitset<54>(static_cast<unsigned long long>(static_cast<long long>(raw)));
  }
  const auto word = static_cast<long long>(parity.to_ullong());
  values[reg_parity] = static_cast<double>(parity[53] ? word - (1LL << 54) : word);
  return values;
}

Eigen::VectorXd Tone::next(Eigen::Index count) {
  return Eigen::VectorXd::NullaryExpr(count, [this] {
    const double value = amplitude_ * std::cos(2.0 * std::numbers::pi * phase_);
    phase_ = modulo(phase_ + step_, 1.0);
    return value;
  });
}

Eigen::VectorXd Noise::next(Eigen::Index count, double sigma) {
  return Eigen::VectorXd::NullaryExpr(count, [this, sigma] { return sigma * normal_(engine_); });
}

Eigen::VectorXd digitise(const Eigen::VectorXd& fraction, int adc_bits) {
  const double full_scale = power_of_two(adc_bits - 1);
  return fraction.unaryExpr(
      [=](double v) { return std::clamp(std::floor(v * full_scale + 0.5), -full_scale, full_scale - 1.0); });
}

Eigen::VectorXd column(const std::vector<ChainRecord>& records, RecordWord word, std::size_t from) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(records.size() - from));
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out[i] = records[from + static_cast<std::size_t>(i)].words[word];
  return out;
}

Eigen::VectorXd line_spectrum(const Eigen::VectorXd& series) {
  const Eigen::Index n = series.size();
  const Eigen::ArrayXd window = 0.5 - 0.5 * (2.0 * std::numbers::pi / static_cast<double>(n) *
                                             Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)))
                                                .cos();
  const Eigen::VectorXd input = (series.array() - series.mean()) * window;
  Eigen::FFT<double> fft;
  Eigen::VectorXcd transform;
  fft.fwd(transform, input);
  return transform.head(n / 2).cwiseAbs() * (2.0 / window.sum());
}

double line_slope(const Eigen::VectorXd& values) {
  const auto last = static_cast<double>(values.size() - 1);
  const Eigen::VectorXd centred = Eigen::VectorXd::LinSpaced(values.size(), -last / 2.0, last / 2.0);
  return centred.dot(values) / centred.squaredNorm();
}

}  // namespace hemi::golden::testing

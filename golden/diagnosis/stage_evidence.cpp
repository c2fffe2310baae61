// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/stage_evidence.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hemi::diagnosis {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kDacFullScale = 32768.0;
constexpr Index kActsAfter = 2;    // a word acts from the second sample after its own
constexpr Index kStandsAfter = 3;  // and stands while the third is taken

// Words of one DAC over full scale, as they stand `later` samples after the sample they come from.
VectorXd words_of(const std::vector<CoreDacs>& dacs, std::size_t which, Index later) {
  VectorXd words = VectorXd::Zero(static_cast<Index>(dacs.size()));
  for (Index n = later; n < words.size(); ++n)
    words[n] = dacs[static_cast<std::size_t>(n - later)][which] / kDacFullScale;
  return words;
}

VectorXcd clock(double frequency_hz, double rate_hz, double shift_samples, Index samples) {
  VectorXcd turns(samples);
  for (Index n = 0; n < samples; ++n)
    turns[n] = std::polar(
        1.0, kTurn * std::fmod(frequency_hz / rate_hz * (static_cast<double>(n) + shift_samples), 1.0));
  return turns;
}

VectorXd unwrapped(const VectorXcd& values) {
  VectorXd phase(values.size());
  for (Index i = 0; i < values.size(); ++i)
    phase[i] = i == 0 ? std::arg(values[0]) : phase[i - 1] + std::arg(values[i] * std::conj(values[i - 1]));
  return phase;
}

// Force of a word in units of D, u = -D sin(phase): Z = j D.
VectorXcd force(const VectorXd& words, const VectorXcd& middle_turn, Index block, const VectorXcd& frame) {
  const VectorXcd amplitude = block_amplitudes(words, middle_turn, block);
  return Complex(0.0, -1.0) * amplitude.cwiseProduct(frame.conjugate());
}

}  // namespace

Index tone_piece(const StageCapture& capture) {
  return std::max<Index>(1000, static_cast<Index>(std::lround(0.04 * capture.sample_rate_hz)));
}

Index settled_from(const StageCapture& capture, const std::vector<CoreWords>& records) {
  const auto block = std::max<Index>(64, static_cast<Index>(std::lround(1e-3 * capture.sample_rate_hz)));
  const Index blocks = capture.x_lsb.size() / block;
  VectorXd height(blocks);
  for (Index b = 0; b < blocks; ++b) {
    const auto part = capture.x_lsb.segment(b * block, block);
    height[b] = std::sqrt((part.array() - part.mean()).square().mean());
  }
  if (blocks < 300) throw std::invalid_argument("a capture for the stages lasts 0.3 s at least");
  // a block of few turns has an rms that depends on where it begins: means over 20 blocks do not
  constexpr Index smooth = 20;
  const double last = height.tail(smooth).mean();
  Index from = blocks - smooth;
  while (from > 0 && std::abs(height.segment(from - 1, smooth).mean() - last) < 0.02 * last) --from;
  from = std::max(from, Index{100});
  for (std::size_t i = records.size(); i-- > 0;) {
    constexpr std::uint64_t waiting =
        std::uint64_t{1} << config::status_starting | std::uint64_t{1} << config::status_unlocked;
    if ((static_cast<std::uint64_t>(records[i][config::word_status]) & waiting) == 0) continue;
    const auto until = static_cast<Index>((i + 1) * capture.recorded.samples_a_record) / block + 50;
    if (until < blocks - 300) from = std::max(from, until);
    break;
  }
  if (blocks - from < 200)
    throw std::invalid_argument("the vibration settles in the last 0.2 s of the capture, or never");
  return from * block;
}

void fit_settled(const StageCapture& capture, Index from, StageDiagnosis& d) {
  const Index samples = capture.x_lsb.size() - from;
  d.tones = fit_tones(capture.x_lsb.tail(samples), capture.sample_rate_hz, tone_piece(capture));
  const VectorXd rest =
      without_fundamental(capture.y_lsb.tail(samples), d.tones.vibration.turn, tone_piece(capture));
  d.mean_y_lsb = rest.mean();
  d.mean_y_sigma_lsb = std::sqrt((rest.array() - rest.mean()).square().mean() / static_cast<double>(samples));
}

Estimate leak_of(const StageCapture& capture, const std::vector<CoreDacs>& dacs, Index from,
                 const ToneFit& tones) {
  const Index samples = capture.x_lsb.size() - from;
  const VectorXd words = capture.full_scale_lsb * words_of(dacs, 0, kStandsAfter).tail(samples);
  return leak(tones.rest_lsb, without_tones(words, tones, tone_piece(capture)), tones.harmonics.noise_lsb);
}

Blocks blocks_of(const StageCapture& capture, const StageNominal& nominal, const std::vector<CoreDacs>& dacs,
                 double leaked, double seconds) {
  const auto block = static_cast<Index>(std::lround(seconds * capture.sample_rate_hz));
  const auto first = static_cast<Index>(std::lround(5e-3 * capture.sample_rate_hz)),
             samples = capture.x_lsb.size() - first;
  const auto part = [&](const VectorXd& v) { return VectorXd(v.tail(samples)); };
  const VectorXd x = part(capture.x_lsb - leaked * capture.full_scale_lsb * words_of(dacs, 0, kStandsAfter));
  // the frequency of the whole, by the phase of its blocks
  double frequency_hz =
      fit_tones(x.tail(samples / 2), capture.sample_rate_hz, tone_piece(capture)).vibration.frequency_hz;
  const VectorXcd turn = clock(frequency_hz, capture.sample_rate_hz, 0.0, samples);
  const VectorXcd middle = clock(frequency_hz, capture.sample_rate_hz, 0.5, samples);

  Blocks b;
  b.omega_rad_s = kTurn * frequency_hz;
  b.seconds = static_cast<double>(block) / capture.sample_rate_hz;
  const VectorXcd primary = block_amplitudes(x, turn, block);
  const VectorXcd frame = primary.cwiseQuotient(primary.cwiseAbs().cast<Complex>());
  const double nominal_lsb = capture.full_scale_lsb * nominal.full_scale_per_amplitude;
  b.amplitude = primary.cwiseAbs() / nominal_lsb;
  b.phase_rad = unwrapped(primary);
  b.secondary =
      block_amplitudes(part(capture.y_lsb), turn, block).cwiseProduct(frame.conjugate()) / nominal_lsb;
  b.drive = force(part(words_of(dacs, 0, kActsAfter)), middle, block, frame);
  b.rebalance = force(part(words_of(dacs, 1, kActsAfter)), middle, block, frame);
  const VectorXd quadrature = part(words_of(dacs, 2, kActsAfter));
  b.quadrature.resize(samples / block);
  for (Index i = 0; i < b.quadrature.size(); ++i)
    b.quadrature[i] = quadrature.segment(i * block, block).mean();
  // White noise s a sample leaves s sqrt(2/n) in each part of an amplitude over n samples; half an LSB and
  // rounding.
  const double part_lsb =
      std::hypot(0.5, 1.0 / std::sqrt(12.0)) * std::sqrt(2.0 / static_cast<double>(block));
  b.secondary_noise = part_lsb / nominal_lsb;
  b.primary_noise_rad = b.secondary_noise / b.amplitude.mean();
  return b;
}

}  // namespace hemi::diagnosis

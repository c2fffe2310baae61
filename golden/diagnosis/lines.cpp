// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/lines.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;
constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kLineLog_p = -16.11809565095832;  // 1e-7: some spectra a recording, tails not quite Gaussian
constexpr double kSpectra = 7.0;                   // plain, two harmonics sampled in three ways
constexpr Index kMedianBins = 101;
constexpr double kSlowRows = 25.0;
constexpr double kLeastMove_hz = 0.5;
constexpr int kLineBits = 20;
constexpr Index kStartRows = 60;
constexpr double kLeastWindowRatio = 6.0;
constexpr Index kMostWindows = 32;

struct Peak {
  double ratio = 0.0;  // power over the local median's mean
  Index bin = 0;
  double level = 0.0;  // noise power of a bin there
};

// Periodogram of e exp(-j phase); both signs of frequency where a phase was taken out.
Peak highest(const VectorXd& e, const VectorXd& phase) {
  Eigen::VectorXcd turned(e.size());
  for (Index i = 0; i < e.size(); ++i) turned[i] = std::polar(1.0, -phase[i]) * e[i];
  Eigen::FFT<double> fft;
  Eigen::VectorXcd spectrum;
  fft.fwd(spectrum, turned);
  const bool plain = phase.isZero();
  const Index bins = plain ? e.size() / 2 : e.size();
  const VectorXd power = spectrum.head(bins).cwiseAbs2();
  Peak best;
  // Below a fiftieth of the row rate noise is red and effects live.
  for (Index begin = plain ? e.size() / 50 + 1 : 0; begin < bins; begin += kMedianBins) {
    const Index count = std::min(kMedianBins, bins - begin);
    if (count < 20) break;
    const VectorXd part = power.segment(begin, count);
    const double level = median(part) / std::numbers::ln2;
    Index at = 0;
    const double top = part.maxCoeff(&at);
    if (level > 0.0 && top / level > best.ratio) best = {top / level, begin + at, level};
  }
  return best;
}

// Phase of a harmonic of the counted frequency at every row [rad]. `within`: share of its row's interval
// after which the line was sampled; cores differ, and a resonator that moves by hertz tells.
VectorXd carrier_phase(const ArrayXd& frequency_hz, double step_s, int harmonic, double within) {
  VectorXd phase(frequency_hz.size());
  double turns = 0.0;
  for (Index i = 0; i < phase.size(); ++i) {
    const double step = harmonic * frequency_hz[i] * step_s;
    phase[i] = kTurn_rad * std::fmod(turns + within * step, 1.0);
    turns += step;
  }
  return phase;
}

// |sum e exp(-j (phase + 2 pi cycles i))|, cycles a row.
double correlation(const VectorXd& e, const VectorXd& phase, double cycles) {
  std::complex<double> sum = 0.0;
  for (Index i = 0; i < e.size(); ++i)
    sum += std::polar(1.0, -phase[i] - kTurn_rad * std::fmod(cycles * static_cast<double>(i), 1.0)) * e[i];
  return std::abs(sum);
}

struct Amplitude {
  double value, deviation;
};

// Window by window, each with a phase of its own: a carrier's phase is summed up from recorded frequencies,
// whose noise makes it wander, and one phase for all rows took up to a tenth off the amplitude. `ratio`:
// power of the line over the noise's, whose `level` is that of a bin of `valid` rows. With E|a_k|^2 = A^2 +
// s^2 of a window, A^2 = mean |a_k|^2 - s^2, var A^2 = (2 A^2 s^2 + s^4) / windows, or by the windows' own
// scatter if that is more: a line need not be steady.
Amplitude by_windows(const Eigen::MatrixX2d& wave, const VectorXd& e, double ratio, double level,
                     double valid) {
  const Index windows = std::clamp<Index>(static_cast<Index>(ratio / kLeastWindowRatio), 1, kMostWindows);
  const Index rows = e.size() / windows;
  ArrayXd squares(windows);
  for (Index k = 0; k < windows; ++k) {
    const auto here = wave.middleRows(k * rows, rows);
    squares[k] =
        (here.transpose() * here).ldlt().solve(here.transpose() * e.segment(k * rows, rows)).squaredNorm();
  }
  const double share = static_cast<double>(e.size()) / valid;  // missing rows are zeros in e
  squares *= share * share;
  const auto count = static_cast<double>(windows);
  const double noise = 4.0 * level * count / (valid * valid);
  const double square = std::max(squares.mean() - noise, 0.5 * noise);
  const double scatter = (squares - squares.mean()).square().sum() / std::max(count - 1.0, 1.0);
  const double variance = std::max(2.0 * square * noise + noise * noise, scatter) / count;
  return {std::sqrt(square), 0.5 * std::sqrt(variance / square)};
}

using HighPass = std::function<VectorXd(const VectorXd&)>;

// Amplitude and frequency by least squares around the peak's bin, with their least deviations; `pass` is what
// e went through. Source: Rife and Boorstyn, Single-tone parameter estimation from discrete-time
// observations, IEEE Trans. Inf. Theory 20 (1974) 591.
Line refined(const VectorXd& e, const VectorXd& phase, const Peak& peak, double valid, double step_s,
             const HighPass& pass) {
  const auto rows = static_cast<double>(e.size());
  const auto bin = static_cast<double>(peak.bin);
  const auto found = boost::math::tools::brent_find_minima(
      [&](double at) { return -correlation(e, phase, at / rows); }, bin - 1.0, bin + 1.0, kLineBits);
  const ArrayXd angle =
      phase.array() + kTurn_rad * found.first / rows * ArrayXd::LinSpaced(e.size(), 0.0, rows - 1.0);
  Eigen::MatrixX2d wave(e.size(), 2);
  wave << pass(angle.cos().matrix()), pass(angle.sin().matrix());
  Line line;
  const Amplitude amplitude = by_windows(wave, e, peak.ratio, peak.level, valid);
  line.amplitude = amplitude.value;
  line.amplitude_deviation = amplitude.deviation;
  line.frequency_hz = found.first / (rows * step_s);
  line.frequency_deviation_hz =
      std::sqrt(24.0 * peak.level) / (line.amplitude * valid * valid * kTurn_rad * step_s);
  return line;
}

// As the rows show a frequency: folded into half their rate.
ArrayXd folded(const ArrayXd& frequency_hz, double step_s) {
  return frequency_hz.unaryExpr([=](double f) { return std::abs(std::remainder(f, 1.0 / step_s)); });
}

}  // namespace

std::optional<Line> find_line(const Telemetry& t, const Simulation& s, Output output,
                              const VectorXd& residual) {
  VectorXd e = residual.array().isNaN().select(0.0, residual);
  const auto valid = static_cast<double>(e.size() - residual.array().isNaN().count());
  if (valid < 512.0) return std::nullopt;
  // What is slow would be spread by the carrier's phase.
  const HighPass pass = [&](const VectorXd& x) -> VectorXd {
    return x - smoothed(x, t.step_s, kSlowRows * t.step_s).matrix();
  };
  const HighPass all = [](const VectorXd& x) { return x; };
  const VectorXd fast = pass(e);
  const ArrayXd nominal = s.smooth_f + s.model.bias_reference_hz;
  // Phase of the carrier itself, by the recorded frequency where there is one.
  ArrayXd carrier = nominal;
  if (t.has(Output::frequency)) {
    const ArrayXd counted = t[Output::frequency];
    carrier = counted.isNaN().select(nominal, counted);
  }
  std::optional<Line> best;
  double ratio = 0.0;
  const auto consider = [&](int harmonic, double within) {
    const VectorXd phase =
        harmonic == 0 ? VectorXd::Zero(e.size()) : carrier_phase(carrier, t.step_s, harmonic, within);
    const Peak peak = highest(fast, phase);
    const double log_p = std::log(kSpectra * static_cast<double>(e.size())) - peak.ratio;
    if (log_p > kLineLog_p || peak.ratio <= ratio) return;
    ratio = peak.ratio;
    best = harmonic == 0 ? refined(e, phase, peak, valid, t.step_s, all)
                         : refined(fast, phase, peak, valid, t.step_s, pass);
    best->output = output;
    best->harmonic = harmonic;
    best->log_p = log_p;
    const double width = 2.0 / (static_cast<double>(e.size()) * t.step_s);
    best->low_hz = best->frequency_hz - width;
    best->high_hz = best->frequency_hz + width;
    if (harmonic == 0) return;
    const ArrayXd off = (carrier - nominal).head(kStartRows);
    const ArrayXd moving = folded(harmonic * (nominal + off.mean()), t.step_s);
    best->frequency_deviation_hz =
        harmonic * std::sqrt((off - off.mean()).square().sum() / (kStartRows - 1.0));
    best->frequency_hz = moving[0];
    best->low_hz = moving.minCoeff();
    best->high_hz = moving.maxCoeff();
  };
  consider(0, 0.0);
  // A carrier that stands still is a standing line; taking its phase out would move red noise elsewhere.
  if (span(nominal) < kLeastMove_hz) return best;
  for (const int harmonic : {1, 2})
    for (const double within : {0.0, 0.5, 1.0}) consider(harmonic, within);
  return best;
}

}  // namespace hemi::diagnosis

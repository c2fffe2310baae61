// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/detectability.hpp"

#include <cmath>
#include <complex>
#include <functional>
#include <unsupported/Eigen/FFT>

#include "golden/concealed/noise.hpp"

namespace hemi::concealed {
namespace {

constexpr Eigen::Index kBlock_s = 20;
constexpr Eigen::Index kGrid = Eigen::Index{1} << 17;  // of the covariance: 36 h, longer than any run

Eigen::VectorXcd spectrum(const Series& values) {
  thread_local Eigen::FFT<double> fft;  // keeps its tables
  Eigen::VectorXcd lines(values.size());
  const Eigen::VectorXcd complex = values.matrix().cast<std::complex<double>>();
  fft.fwd(lines, complex);
  return lines;
}

/// One-sided density of a series, averaged over bands of a third of an octave; read between the bands'
/// centres.
class Periodogram {
 public:
  explicit Periodogram(const Series& values) {
    const double n = static_cast<double>(values.size());
    const Eigen::VectorXcd lines = spectrum(values - values.mean());
    for (double k = 1.0; k < 0.5 * n; k = std::max(k + 1.0, k * 1.26)) {
      const auto from = static_cast<Eigen::Index>(k);
      const auto to = std::min(static_cast<Eigen::Index>(std::max(k + 1.0, k * 1.26)), values.size() / 2);
      if (to <= from) break;
      centre_hz_.push_back(0.5 * static_cast<double>(from + to - 1) / n);
      density_.push_back(lines.segment(from, to - from).cwiseAbs2().mean() * 2.0 / n);
    }
  }
  double operator()(double frequency_hz) const {
    std::size_t i = 0;
    while (i + 1 < centre_hz_.size() && centre_hz_[i + 1] < frequency_hz) ++i;
    if (i + 1 >= centre_hz_.size() || frequency_hz <= centre_hz_[i]) return density_[i];
    const double share = std::log(frequency_hz / centre_hz_[i]) / std::log(centre_hz_[i + 1] / centre_hz_[i]);
    return density_[i] + share * (density_[i + 1] - density_[i]);
  }

 private:
  std::vector<double> centre_hz_{}, density_{};
};

/// Covariance of means over blocks, from a one-sided density.
Eigen::VectorXd block_covariance(const std::function<double(double)>& total, Eigen::Index blocks) {
  Eigen::VectorXcd lines(kGrid);
  const double n = static_cast<double>(kGrid);
  for (Eigen::Index k = 0; k <= kGrid / 2; ++k) {
    const double value = 0.5 * total(std::max(static_cast<double>(k), 0.5) / n);
    lines[k] = value;
    if (k > 0 && k < kGrid / 2) lines[kGrid - k] = value;
  }
  thread_local Eigen::FFT<double> fft;
  Eigen::VectorXcd lags(kGrid);
  fft.inv(lags, lines);
  Eigen::VectorXd covariance = Eigen::VectorXd::Zero(blocks);
  for (Eigen::Index m = 0; m < blocks; ++m) {
    for (Eigen::Index j = 1 - kBlock_s; j < kBlock_s; ++j) {
      const double weight = 1.0 - static_cast<double>(std::abs(j)) / static_cast<double>(kBlock_s);
      covariance[m] += weight * lags[std::abs(m * kBlock_s + j)].real() / static_cast<double>(kBlock_s);
    }
  }
  return covariance;
}

/// Inverse Cholesky factor of a Toeplitz matrix times a vector: one-step prediction errors of growing order.
Eigen::VectorXd toeplitz_white(const Eigen::VectorXd& covariance, const Eigen::VectorXd& values) {
  const Eigen::Index n = values.size();
  Eigen::VectorXd predictor = Eigen::VectorXd::Zero(n), next(n), errors(n);
  double variance = covariance[0];
  errors[0] = values[0] / std::sqrt(variance);
  for (Eigen::Index m = 1; m < n; ++m) {
    double reflection = covariance[m];
    if (m > 1) reflection -= predictor.head(m - 1).dot(covariance.segment(1, m - 1).reverse());
    reflection /= variance;
    next.head(m - 1) = predictor.head(m - 1) - reflection * predictor.head(m - 1).reverse();
    predictor.head(m - 1) = next.head(m - 1);
    predictor[m - 1] = reflection;
    variance *= 1.0 - reflection * reflection;
    errors[m] = (values[m] - predictor.head(m).dot(values.head(m).reverse())) / std::sqrt(variance);
  }
  return errors;
}

/// Rows [first, second) of every power cut.
std::vector<std::pair<Eigen::Index, Eigen::Index>> cuts_of(const Series& power) {
  std::vector<std::pair<Eigen::Index, Eigen::Index>> cuts;
  for (Eigen::Index i = 0; i < power.size(); ++i) {
    if (power[i] != 0.0) continue;
    if (!cuts.empty() && cuts.back().second == i)
      ++cuts.back().second;
    else
      cuts.emplace_back(i, i + 1);
  }
  return cuts;
}

Trace difference(const State& a, const State& b) {
  Trace trace;
  for (int output = 0; output < kOutputs; ++output) trace[output] = a.output(output) - b.output(output);
  return trace;
}

}  // namespace

Trace thermometer_trace(const Series& error_degc, const State& without, const Model& model,
                        const Excitation& in, double start_offset_degc) {
  Excitation misread = in;
  misread.case_ahead_degc += error_degc;
  // The start is refitted: the resonator is where it is, whatever the thermometer says at that moment.
  return difference(simulate(model, misread, start_offset_degc - error_degc[0]), without);
}

Trace trace_of(const State& with, const State& without, const Model& model, const Excitation& in,
               double start_offset_degc) {
  Trace trace = difference(with, without);
  const Series error_degc = with.case_reading_degc - in.case_degc;
  if ((error_degc != 0.0).any()) {
    const Trace own = thermometer_trace(error_degc, without, model, in, start_offset_degc);
    for (int output = 0; output < kOutputs; ++output) trace[output] -= own[output];
  }
  return trace;
}

Detectability::Detectability(const Model& model, const Excitation& in, double start_offset_degc,
                             const std::array<NoiseLevel, kOutputs>& noise, const Trace& thermometer)
    : samples_(in.time_s.size()), blocks_(samples_ / kBlock_s), cuts_(cuts_of(in.power)) {
  for (int output = 0; output < kOutputs; ++output) {
    const Periodogram from_case(thermometer[output]);
    const auto total = [&](double f) { return density(noise[output], f) + from_case(f); };
    block_covariance_[output] = block_covariance(total, blocks_);
    fast_scale_[output].resize(samples_ / 2);
    for (Eigen::Index k = 0; k < samples_ / 2; ++k) {
      const double f = std::max(static_cast<double>(k) / static_cast<double>(samples_), 0.5 / kBlock_s);
      fast_scale_[output][k] = 1.0 / std::sqrt(0.5 * total(f));
    }
  }
  const auto vary = [&](const std::function<void(Model&, Excitation&, double&, double)>& change,
                        double step) {
    const auto at = [&](double by) {
      Model changed = model;
      Excitation moved = in;
      double offset = start_offset_degc;
      change(changed, moved, offset, by);
      return simulate(changed, moved, offset);
    };
    add_nuisance(difference(at(step), at(-step)));
  };
  for (std::size_t k = 0; k < model.frequency_hz.size(); ++k)
    vary([k](Model& m, Excitation&, double&, double by) { m.frequency_hz[k] += by; },
         1e-2 / std::pow(30.0, static_cast<double>(k)));
  vary([](Model& m, Excitation&, double&, double by) { m.time_constant_s += by; },
       1e-3 * model.time_constant_s);
  vary([](Model&, Excitation&, double& offset, double by) { offset += by; }, 0.02);
  vary([](Model&, Excitation& e, double&, double by) { e.case_ahead_degc = later(e.case_ahead_degc, by); },
       0.3);
  // How warm the case was while nothing was recorded: the resonator may be anywhere afterwards.
  for (const auto& [from, to] : cuts_)
    vary([from = from, to = to](Model&, Excitation& e, double&,
                                double by) { e.case_ahead_degc.segment(from, to - from) += by; },
         0.1);
  // f reaches 10 Hz, df 3 mHz/s: steps that make about 1 deg/h each.
  const std::array<std::array<int, 2>, 10> powers{
      {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 1}, {2, 1}, {1, 2}}};
  for (std::size_t k = 0; k < 10; ++k)
    vary([k](Model& m, Excitation&, double&, double by) { m.bias_dph[k] += by; },
         std::pow(10.0, -powers[k][0]) * std::pow(3e-3, -powers[k][1]));
  vary([](Model& m, Excitation&, double&, double by) { m.scale_factor += by; }, 1e-5);
  for (std::size_t k = 0; k < model.drive_v.size(); ++k)
    vary([k](Model& m, Excitation&, double&, double by) { m.drive_v[k] += by; },
         1e-2 / std::pow(30.0, static_cast<double>(k)));
  for (std::size_t k = 0; k < model.quadrature_v.size(); ++k)
    vary([k](Model& m, Excitation&, double&, double by) { m.quadrature_v[k] += by; },
         1e-2 / std::pow(30.0, static_cast<double>(k)));
}

Eigen::VectorXd Detectability::white(const Trace& trace) const {
  const Eigen::Index fast = 2 * (samples_ / 2 - 1), each = blocks_ + fast;
  Eigen::VectorXd all = Eigen::VectorXd::Zero(kOutputs * each);
  for (int output = 0; output < kOutputs; ++output) {
    if (!(trace[output] != 0.0).any()) continue;
    Series values = trace[output];
    for (const auto& [from, to] : cuts_) {  // straight across what the file does not hold
      const double before = values[std::max<Eigen::Index>(from - 1, 0)];
      const double after = values[std::min(to, samples_ - 1)];
      values.segment(from, to - from) = Series::LinSpaced(to - from, before, after);
    }
    Eigen::VectorXd means(blocks_);
    Series within = values;
    for (Eigen::Index b = 0; b < blocks_; ++b) {
      means[b] = values.segment(b * kBlock_s, kBlock_s).mean();
      within.segment(b * kBlock_s, kBlock_s) -= means[b];
    }
    all.segment(output * each, blocks_) = toeplitz_white(block_covariance_[output], means);
    const Eigen::VectorXcd lines = spectrum(within);
    const double normal = std::sqrt(2.0 / static_cast<double>(samples_));  // both halves of the spectrum
    for (Eigen::Index k = 1; k < samples_ / 2; ++k) {
      const std::complex<double> line = lines[k] * (normal * fast_scale_[output][k]);
      all[output * each + blocks_ + 2 * (k - 1)] = line.real();
      all[output * each + blocks_ + 2 * (k - 1) + 1] = line.imag();
    }
  }
  return all;
}

void Detectability::add_nuisance(const Trace& trace) {
  Eigen::VectorXd column = white(trace);
  const double before = column.norm();
  if (before == 0.0) return;
  for (int pass = 0; pass < 2; ++pass)
    for (const auto& done : basis_) column -= done.dot(column) * done;
  // What is left below the finite differences' own error is no direction.
  if (column.norm() > 1e-6 * before) basis_.push_back(column.normalized());
}

Eigen::VectorXd Detectability::projected(const Trace& trace) const {
  Eigen::VectorXd values = white(trace);
  for (const auto& done : basis_) values -= done.dot(values) * done;
  return values;
}

double Detectability::dprime(const Trace& trace) const {
  return projected(trace).norm();
}

double Detectability::raw(const Trace& trace) const {
  return white(trace).norm();
}

double Detectability::dprime_beside(const Trace& trace, const Trace& other) const {
  const Eigen::VectorXd mine = projected(trace), theirs = projected(other);
  const double norm = theirs.squaredNorm();
  if (norm == 0.0) return mine.norm();
  return (mine - theirs * (mine.dot(theirs) / norm)).norm();
}

Detectability::Share Detectability::share(const Trace& trace) const {
  const Eigen::VectorXd values = projected(trace);
  Share result;
  result.dprime = values.norm();
  const Eigen::Index each = values.size() / kOutputs;
  for (int output = 0; output < kOutputs; ++output) {
    result.channel[output] = values.segment(output * each, each).squaredNorm();
    result.block[output].resize(static_cast<std::size_t>(blocks_));
    for (Eigen::Index b = 0; b < blocks_; ++b)
      result.block[output][static_cast<std::size_t>(b)] = std::pow(values[output * each + b], 2);
  }
  return result;
}

}  // namespace hemi::concealed

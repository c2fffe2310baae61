// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/stage_tones.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hemi::diagnosis {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kTone_rad = 2.0 * std::numbers::pi;
constexpr int kHighest = 40;

// Rising passages through the mean, the first and the last placed between samples.
double rough_frequency_hz(const VectorXd& x, double rate_hz) {
  const double mean = x.mean();
  double first = -1.0, last = -1.0;
  int passages = 0;
  for (Index n = 1; n < x.size(); ++n) {
    const double before = x[n - 1] - mean, after = x[n] - mean;
    if (!(before < 0.0 && after >= 0.0)) continue;
    last = static_cast<double>(n) - after / (after - before);
    if (first < 0.0) first = last;
    ++passages;
  }
  if (passages < 10) throw std::invalid_argument("no vibration in the samples");
  return (passages - 1) / (last - first) * rate_hz;
}

// exp(j step i), i = 0, 1, ...: by recurrence, set right every 64 samples.
void fill_turns(double step_rad, double start_rad, VectorXcd& turns) {
  const Complex step = std::polar(1.0, step_rad);
  for (Index i = 0; i < turns.size(); ++i)
    turns[i] =
        i % 64 == 0 ? std::polar(1.0, start_rad + step_rad * static_cast<double>(i)) : turns[i - 1] * step;
}

// Quadratic complex amplitude of one piece about carrier turns, with constant, second and third harmonic
// beside it.
struct Piece {
  Complex a0, a1, a2;
  Complex at(double u) const { return a0 + u * (a1 + u * a2); }
};

double position(Index i, Index n) {
  return n > 1 ? 2.0 * static_cast<double>(i) / static_cast<double>(n - 1) - 1.0 : 0.0;
}

Piece fit_piece(const Eigen::Ref<const VectorXd>& x, const VectorXcd& turns) {
  constexpr int columns = 11;
  Eigen::Matrix<double, columns, columns> normal = Eigen::Matrix<double, columns, columns>::Zero();
  Eigen::Matrix<double, columns, 1> right = Eigen::Matrix<double, columns, 1>::Zero();
  Eigen::Matrix<double, columns, 1> row;
  for (Index i = 0; i < x.size(); ++i) {
    const double u = position(i, x.size());
    const Complex t = turns[i], t2 = t * t, t3 = t2 * t;
    row << 1.0, t.real(), -t.imag(), u * t.real(), -u * t.imag(), u * u * t.real(), -u * u * t.imag(),
        t2.real(), t2.imag(), t3.real(), t3.imag();
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    right += x[i] * row;
  }
  const Eigen::Matrix<double, columns, 1> c = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
  return {{c[1], c[2]}, {c[3], c[4]}, {c[5], c[6]}};
}

// Pieces of equal length but for the last, which takes the rest.
Index piece_count(Index samples, Index piece) {
  return samples / piece;
}
Index piece_length(Index p, Index samples, Index piece) {
  return p + 1 < piece_count(samples, piece) ? piece : samples - p * piece;
}

void track(const VectorXd& x, double rate_hz, Index piece, Vibration& vibration) {
  const Index n = x.size();
  vibration.turn.resize(n);
  vibration.amplitude_lsb.resize(n);
  double hz = vibration.frequency_hz, sum_hz = 0.0;
  for (Index p = 0; p < piece_count(n, piece); ++p) {
    const Index length = piece_length(p, n, piece);
    VectorXcd carrier(length);
    Piece fit{};
    for (int pass = 0; pass < 2; ++pass) {
      fill_turns(kTone_rad * hz / rate_hz, 0.0, carrier);
      fit = fit_piece(x.segment(p * piece, length), carrier);
      if (pass > 0) break;
      // slope of the phase in the middle of the piece
      const double slope_rad = (fit.a1 / fit.a0).imag() * 2.0 / static_cast<double>(length - 1);
      hz += slope_rad * rate_hz / kTone_rad;
    }
    sum_hz += hz;
    for (Index i = 0; i < length; ++i) {
      const Complex a = fit.at(position(i, length));
      vibration.amplitude_lsb[p * piece + i] = std::abs(a);
      vibration.turn[p * piece + i] = carrier[i] * a / std::abs(a);
    }
  }
  vibration.frequency_hz = sum_hz / static_cast<double>(piece_count(n, piece));
}

// Sums of exp(j m phase), m = 0..2 highest.
std::vector<Complex> turn_sums(const VectorXcd& turn, int highest) {
  std::vector<Complex> sums(static_cast<std::size_t>(2 * highest + 1));
  for (Index n = 0; n < turn.size(); ++n) {
    Complex power = 1.0;
    for (auto& sum : sums) {
      sum += power;
      power *= turn[n];
    }
  }
  return sums;
}

// k = 2, 3, ... that fold onto no other one: the sum of exp(j (k + l) phase) is then small against the
// samples.
std::vector<int> separate_orders(const std::vector<Complex>& sums, double samples) {
  constexpr double most = 0.02;
  std::vector<int> orders;
  for (int k = 2; k <= kHighest; ++k) {
    bool alone = std::abs(sums[static_cast<std::size_t>(k)]) < most * samples &&
                 std::abs(sums[static_cast<std::size_t>(2 * k)]) < most * samples &&
                 std::abs(sums[static_cast<std::size_t>(k + 1)]) < most * samples;
    for (const int l : orders) {
      alone = alone && std::abs(sums[static_cast<std::size_t>(k + l)]) < most * samples &&
              std::abs(sums[static_cast<std::size_t>(k - l)]) < most * samples;
    }
    if (alone) orders.push_back(k);
  }
  return orders;
}

// From <e^{j(k-l)}> and <e^{j(k+l)}>: normal matrix of c0, c_k, s_k.
MatrixXd normal_matrix(const std::vector<Complex>& sums, const std::vector<int>& orders) {
  const auto count = static_cast<Index>(orders.size());
  MatrixXd normal(2 * count + 1, 2 * count + 1);
  const auto at = [&](int m) {
    return m < 0 ? std::conj(sums[static_cast<std::size_t>(-m)]) : sums[static_cast<std::size_t>(m)];
  };
  normal(0, 0) = sums[0].real();
  for (Index i = 0; i < count; ++i) {
    const int k = orders[static_cast<std::size_t>(i)];
    normal(0, 1 + i) = normal(1 + i, 0) = at(k).real();
    normal(0, 1 + count + i) = normal(1 + count + i, 0) = at(k).imag();
    for (Index j = 0; j < count; ++j) {
      const int l = orders[static_cast<std::size_t>(j)];
      normal(1 + i, 1 + j) = 0.5 * (at(k - l).real() + at(k + l).real());
      normal(1 + count + i, 1 + count + j) = 0.5 * (at(k - l).real() - at(k + l).real());
      normal(1 + i, 1 + count + j) = 0.5 * (at(k + l).imag() - at(k - l).imag());
      normal(1 + count + j, 1 + i) = normal(1 + i, 1 + count + j);
    }
  }
  return normal;
}

VectorXd project(const VectorXd& signal, const VectorXcd& turn, const std::vector<int>& orders) {
  const auto count = static_cast<Index>(orders.size());
  VectorXcd sums = VectorXcd::Zero(kHighest + 1);
  for (Index n = 0; n < signal.size(); ++n) {
    Complex power = signal[n];
    for (int k = 0; k <= kHighest; ++k) {
      sums[k] += power;
      power *= turn[n];
    }
  }
  VectorXd right(2 * count + 1);
  right[0] = sums[0].real();
  for (Index i = 0; i < count; ++i) {
    right[1 + i] = sums[orders[static_cast<std::size_t>(i)]].real();
    right[1 + count + i] = sums[orders[static_cast<std::size_t>(i)]].imag();
  }
  return right;
}

// c0 + sum c_k cos + s_k sin at every sample.
VectorXd synthesise(const VectorXd& value, const VectorXcd& turn, const std::vector<int>& orders) {
  const auto count = static_cast<Index>(orders.size());
  VectorXcd weight = VectorXcd::Zero(kHighest + 1);
  weight[0] = value[0];
  for (Index i = 0; i < count; ++i)
    weight[orders[static_cast<std::size_t>(i)]] = Complex(value[1 + i], -value[1 + count + i]);
  VectorXd sum(turn.size());
  for (Index n = 0; n < turn.size(); ++n) {
    Complex total = 0.0;
    for (int k = kHighest; k >= 0; --k) total = total * turn[n] + weight[k];
    sum[n] = total.real();
  }
  return sum;
}

}  // namespace

ToneFit fit_tones(const VectorXd& samples, double rate_hz, Index piece) {
  if (samples.size() < 2 * piece)
    throw std::invalid_argument("too few samples for the harmonics of the vibration");
  ToneFit fit;
  fit.vibration.frequency_hz = rough_frequency_hz(samples, rate_hz);
  VectorXd harmonic = VectorXd::Zero(samples.size());
  // A harmonic disturbs a piece's fundamental by a share of 1/(turns of the piece), 1 % and less: each pass
  // gains that.
  for (int pass = 0; pass < 4; ++pass) {
    track(samples - harmonic, rate_hz, piece, fit.vibration);
    const VectorXd beyond = samples - fit.vibration.amplitude_lsb.cwiseProduct(fit.vibration.turn.real());
    const auto sums = turn_sums(fit.vibration.turn, kHighest);
    fit.harmonics.order = separate_orders(sums, static_cast<double>(samples.size()));
    const MatrixXd normal = normal_matrix(sums, fit.harmonics.order);
    fit.harmonics.value_lsb = normal.ldlt().solve(project(beyond, fit.vibration.turn, fit.harmonics.order));
    harmonic = synthesise(fit.harmonics.value_lsb, fit.vibration.turn, fit.harmonics.order);
    fit.rest_lsb = beyond - harmonic;
    const double fitted =
        static_cast<double>(6 * piece_count(samples.size(), piece) + fit.harmonics.value_lsb.size());
    fit.harmonics.noise_lsb =
        std::sqrt(fit.rest_lsb.squaredNorm() / (static_cast<double>(samples.size()) - fitted));
    fit.harmonics.information = normal / (fit.harmonics.noise_lsb * fit.harmonics.noise_lsb);
  }
  fit.harmonics.amplitude_lsb = fit.vibration.amplitude_lsb.mean();
  return fit;
}

VectorXd without_fundamental(const VectorXd& signal, const VectorXcd& turn, Index piece) {
  VectorXd rest = signal;
  for (Index p = 0; p < piece_count(signal.size(), piece); ++p) {
    const Index length = piece_length(p, signal.size(), piece);
    const VectorXcd carrier = turn.segment(p * piece, length);
    const Piece part = fit_piece(signal.segment(p * piece, length), carrier);
    for (Index i = 0; i < length; ++i)
      rest[p * piece + i] -= (part.at(position(i, length)) * carrier[i]).real();
  }
  return rest;
}

VectorXd without_tones(const VectorXd& signal, const ToneFit& fit, Index piece) {
  const VectorXcd& turn = fit.vibration.turn;
  const VectorXd rest = without_fundamental(signal, turn, piece);
  const MatrixXd normal = normal_matrix(turn_sums(turn, kHighest), fit.harmonics.order);
  return rest -
         synthesise(normal.ldlt().solve(project(rest, turn, fit.harmonics.order)), turn, fit.harmonics.order);
}

VectorXcd block_amplitudes(const VectorXd& signal, const VectorXcd& turn, Index block) {
  using Row = Eigen::Matrix<double, 5, 1>;
  const Index blocks = signal.size() / block;
  VectorXcd amplitude(blocks);
  for (Index b = 0; b < blocks; ++b) {
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
    Row right = Row::Zero();
    for (Index i = 0; i < block; ++i) {
      const Complex t = turn[b * block + i];
      const double u = position(i, block);
      const Row row{1.0, t.real(), -t.imag(), u * t.real(), -u * t.imag()};
      normal += row * row.transpose();
      right += signal[b * block + i] * row;
    }
    const Row c = normal.ldlt().solve(right);
    amplitude[b] = {c[1], c[2]};
  }
  return amplitude;
}

}  // namespace hemi::diagnosis

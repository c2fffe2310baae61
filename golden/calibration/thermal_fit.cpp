// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/thermal_fit.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "golden/calibration/nonlinear_fit.hpp"

namespace hemi::calibration {
namespace {

constexpr Eigen::Index kThermalRows = 1500;
constexpr double kLeastTravelDegc = 1.0;
constexpr double kOrderLevel = 0.05;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<RowBlocks::Range> whole(const std::vector<ThermalStretch>& stretches) {
  std::vector<RowBlocks::Range> ranges;
  for (std::size_t s = 0; s < stretches.size(); ++s) ranges.push_back({s, 0, stretches[s].time_s.size()});
  return ranges;
}

// f(T) is fitted over z = (T - middle) / half, within [-1, 1], so that its columns are of one size.
struct Scale {
  double middle;
  double half;
};

Scale scale_of(const std::vector<ThermalStretch>& stretches) {
  double low = kInfinity, high = -kInfinity;
  for (const auto& s : stretches) {
    low = std::min(low, s.case_degc.minCoeff());
    high = std::max(high, s.case_degc.maxCoeff());
  }
  if (!(high - low >= kLeastTravelDegc))
    throw std::invalid_argument(
        "the case temperature hardly moves, so nothing shows f(T) or a time constant");
  return {0.5 * (low + high), 0.5 * (high - low)};
}

double evaluate(const Eigen::VectorXd& c, double z) {
  double y = 0.0;
  for (Eigen::Index k = c.size() - 1; k >= 0; --k) y = y * z + c[k];
  return y;
}

double derivative(const Eigen::VectorXd& c, double z) {
  double y = 0.0;
  for (Eigen::Index k = c.size() - 1; k >= 1; --k) y = y * z + static_cast<double>(k) * c[k];
  return y;
}

// p(z) with z = (x - middle) / half as coefficients of (x - reference)^i: out = matrix * c.
Eigen::MatrixXd change_of_origin(Eigen::Index size, double middle, double half, double reference) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(size, size);
  if (size == 0) return m;
  const double shift = (reference - middle) / half;
  Eigen::VectorXd power = Eigen::VectorXd::Unit(size, 0);  // of (u / half + shift)^k
  for (Eigen::Index k = 0; k < size; ++k) {
    m.col(k) = power;
    Eigen::VectorXd next = shift * power;
    next.tail(size - 1) += power.head(size - 1) / half;
    power = next;
  }
  return m;
}

// The fitted quantities in the order of theta.
class Layout {
 public:
  Layout(Eigen::Index coefficients, std::size_t stretches)
      : coefficients_(coefficients), stretches_(static_cast<Eigen::Index>(stretches)) {}
  Eigen::Index coefficients() const { return coefficients_; }
  Eigen::Index log_tau() const { return coefficients_; }
  Eigen::Index lag() const { return coefficients_ + 1; }
  Eigen::Index start(std::size_t stretch) const {
    return coefficients_ + 2 + static_cast<Eigen::Index>(stretch);
  }
  Eigen::Index size() const { return coefficients_ + 2 + stretches_; }

 private:
  Eigen::Index coefficients_;
  Eigen::Index stretches_;
};

class Simulation {
 public:
  Simulation(const std::vector<ThermalStretch>& stretches, const RowBlocks& blocks, const Layout& layout,
             const Scale& scale, const std::optional<Eigen::VectorXd>& known)
      : stretches_(stretches), blocks_(blocks), layout_(layout), scale_(scale), known_(known) {}

  void operator()(const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian) const {
    residual = Eigen::VectorXd::Zero(blocks_.rows());
    // One column a parameter, rows gathered along it: transposed while it is filled, for the cache's sake.
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(layout_.size(), blocks_.rows());
    for (std::size_t s = 0; s < stretches_.size(); ++s) add_stretch(theta, s, residual, columns);
    for (Eigen::Index b = 0; b < blocks_.rows(); ++b) {
      const double weight = 1.0 / (static_cast<double>(blocks_.used(b)) * per_degc_[b]);
      residual[b] *= weight;
      columns.col(b) *= weight;
    }
    jacobian = columns.transpose();
  }

  /// From now on rows are divided by |df/dT| as `theta` has it: the thermometer's noise, which is most of it,
  /// is then of one size at all temperatures.
  void weigh(const Eigen::VectorXd& theta) {
    const Eigen::VectorXd c = known_ ? *known_ : Eigen::VectorXd(theta.head(layout_.coefficients()));
    per_degc_ = Eigen::VectorXd::Zero(blocks_.rows());
    for (std::size_t s = 0; s < stretches_.size(); ++s) {
      const FilterResponse t = thermal_filter(stretches_[s], 0, stretches_[s].time_s.size(),
                                              std::exp(theta[layout_.log_tau()]), theta[layout_.start(s)]);
      for (Eigen::Index i = 0; i < t.temperature_degc.size(); ++i) {
        const Eigen::Index b = blocks_.block(s, i);
        if (b < 0) continue;
        const double z = (t.temperature_degc[i] - scale_.middle) / scale_.half;
        per_degc_[b] += derivative(c, z) / scale_.half / static_cast<double>(blocks_.used(b));
      }
    }
    // Where a crude f(T) turns round, rows would weigh too much.
    const double typical = per_degc_.cwiseAbs().mean();
    per_degc_ = per_degc_.cwiseAbs().cwiseMax(0.1 * typical);
  }
  const Eigen::VectorXd& hz_per_degc() const { return per_degc_; }

 private:
  void add_stretch(const Eigen::VectorXd& theta, std::size_t s, Eigen::VectorXd& residual,
                   Eigen::MatrixXd& columns) const {
    const ThermalStretch& stretch = stretches_[s];
    const double tau_s = std::exp(theta[layout_.log_tau()]);
    const double lag_s = theta[layout_.lag()];
    const FilterResponse t =
        thermal_filter(stretch, 0, stretch.time_s.size(), tau_s, theta[layout_.start(s)]);
    const Eigen::VectorXd c = known_ ? *known_ : theta.head(layout_.coefficients());
    for (Eigen::Index i = 0; i < stretch.time_s.size(); ++i) {
      const Eigen::Index b = blocks_.block(s, i);
      if (b < 0) continue;
      // T(t - lag) = T - lag dT/dt, with dT/dt = (case - T) / tau.
      const double slope = (stretch.case_degc[i] - t.temperature_degc[i]) / tau_s;
      const double z = (t.temperature_degc[i] - lag_s * slope - scale_.middle) / scale_.half;
      const double per_degc = derivative(c, z) / scale_.half;
      residual[b] += stretch.frequency_hz[i] - evaluate(c, z);
      auto column = columns.col(b);
      double power = 1.0;
      for (Eigen::Index k = 0; k < layout_.coefficients(); ++k, power *= z) column[k] += power;
      const double through_lag = 1.0 + lag_s / tau_s;
      column[layout_.log_tau()] += per_degc * (through_lag * t.per_log_tau[i] + lag_s * slope);
      column[layout_.lag()] -= per_degc * slope;
      column[layout_.start(s)] += per_degc * through_lag * t.per_start[i];
    }
  }

  const std::vector<ThermalStretch>& stretches_;
  const RowBlocks& blocks_;
  Layout layout_;
  Scale scale_;
  const std::optional<Eigen::VectorXd>& known_;
  Eigen::VectorXd per_degc_;
};

// Everything but the time constant is linear once T[0] is that of the case plus a decaying rest: the time
// constant with the smallest sum of squares on a grid, by thinned rows.
Eigen::VectorXd start_values(const std::vector<ThermalStretch>& stretches, const Layout& layout,
                             const Scale& scale, const std::optional<Eigen::VectorXd>& known) {
  Eigen::Index total = 0;
  for (const auto& s : stretches) total += s.time_s.size();
  const Eigen::Index thin = block_length(total, kThermalRows);
  const Eigen::Index order = known ? known->size() - 1 : std::min<Eigen::Index>(layout.coefficients() - 1, 3);
  double least = kInfinity;
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(layout.size());
  for (double tau_s = 20.0; tau_s < 3e4; tau_s *= 1.15) {
    std::vector<double> z, y, starts;
    std::vector<std::pair<std::size_t, double>> decays;
    for (std::size_t s = 0; s < stretches.size(); ++s) {
      const ThermalStretch& stretch = stretches[s];
      const auto t = thermal_filter(stretch, 0, stretch.time_s.size(), tau_s, stretch.case_degc[0]);
      for (Eigen::Index i = 0; i < stretch.time_s.size(); i += thin) {
        if (std::isnan(stretch.frequency_hz[i])) continue;
        z.push_back((t.temperature_degc[i] - scale.middle) / scale.half);
        y.push_back(stretch.frequency_hz[i]);
        decays.emplace_back(s, t.per_start[i]);
      }
    }
    const auto rows = static_cast<Eigen::Index>(z.size());
    const Eigen::Index columns = (known ? 0 : order + 1) + static_cast<Eigen::Index>(stretches.size());
    if (rows < columns) break;
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(rows, columns);
    Eigen::VectorXd target = Eigen::VectorXd::Map(y.data(), rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (known) target[i] -= evaluate(*known, z[at]);
      double power = 1.0;
      for (Eigen::Index k = 0; !known && k <= order; ++k, power *= z[at]) x(i, k) = power;
      x(i, columns - static_cast<Eigen::Index>(stretches.size() - decays[at].first)) = decays[at].second;
    }
    const Eigen::VectorXd b = x.colPivHouseholderQr().solve(target);
    const double sum = (target - x * b).squaredNorm();
    if (!(sum < least)) continue;
    least = sum;
    if (!known) theta.head(order + 1) = b.head(order + 1);
    theta[layout.log_tau()] = std::log(tau_s);
    const Eigen::VectorXd c = known ? *known : Eigen::VectorXd(theta.head(layout.coefficients()));
    for (std::size_t s = 0; s < stretches.size(); ++s) {
      const double case_degc = stretches[s].case_degc[0];
      const double per_degc = derivative(c, (case_degc - scale.middle) / scale.half) / scale.half;
      const double extra = b[columns - static_cast<Eigen::Index>(stretches.size() - s)] / per_degc;
      // A rest that died away within a row or two says nothing about T[0].
      theta[layout.start(s)] = case_degc + std::clamp(extra, -2.0 * scale.half, 2.0 * scale.half);
    }
  }
  return theta;
}

std::vector<std::string> names_of(const Layout& layout, std::size_t stretches) {
  std::vector<std::string> names;
  for (Eigen::Index k = 0; k < layout.coefficients(); ++k) names.push_back(fmt::format("a{}", k));
  names.emplace_back("time constant");
  names.emplace_back("lag of the case");
  for (std::size_t s = 0; s < stretches; ++s) names.push_back(fmt::format("T[0] of stretch {}", s + 1));
  return names;
}

std::pair<double, double> range_of(const std::vector<ThermalStretch>& stretches, double tau_s,
                                   const Eigen::VectorXd& start_degc) {
  double low = kInfinity, high = -kInfinity;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const auto t = thermal_filter(stretches[s], 0, stretches[s].time_s.size(), tau_s,
                                  start_degc[static_cast<Eigen::Index>(s)]);
    for (Eigen::Index i = 0; i < t.temperature_degc.size(); ++i) {
      if (std::isnan(stretches[s].frequency_hz[i])) continue;
      low = std::min(low, t.temperature_degc[i]);
      high = std::max(high, t.temperature_degc[i]);
    }
  }
  return {low, high};
}

}  // namespace

Eigen::VectorXd ThermalFit::temperature_degc(const std::vector<ThermalStretch>& stretches,
                                             std::size_t which) const {
  const ThermalStretch& stretch = stretches[which];
  const auto t = thermal_filter(stretch, 0, stretch.time_s.size(), time_constant_s,
                                start_degc[static_cast<Eigen::Index>(which)]);
  return t.temperature_degc - (lag_s / time_constant_s) * (stretch.case_degc - t.temperature_degc);
}

ThermalFit fit_thermal(const std::vector<ThermalStretch>& stretches, const ThermalOptions& options) {
  const Scale scale = scale_of(stretches);
  const Layout layout(options.known ? 0 : options.order + 1, stretches.size());
  std::optional<Eigen::VectorXd> known;
  if (options.known) {
    const auto& p = *options.known;
    known = change_of_origin(p.order() + 1, p.reference_degc(), 1.0, scale.middle) * p.coefficients_hz();
    for (Eigen::Index k = 0; k <= p.order(); ++k) (*known)[k] *= std::pow(scale.half, static_cast<double>(k));
  }
  Eigen::Index total = 0;
  for (const auto& s : stretches) total += s.time_s.size();
  const Eigen::Index averaged = block_length(total, kThermalRows);
  const RowBlocks blocks(stretches, whole(stretches), averaged);
  NonlinearProblem problem;
  const Eigen::VectorXd start = start_values(stretches, layout, scale, known);
  Simulation simulation(stretches, blocks, layout, scale, known);
  simulation.weigh(start);
  problem.evaluate = simulation;
  for (std::size_t i = 0; i < blocks.begins().size(); ++i)
    problem.segments.push_back({blocks.begins()[i], blocks.counts()[i]});
  problem.names = names_of(layout, stretches.size());
  problem.prior_mean = Eigen::VectorXd::Zero(layout.size());
  problem.prior_deviation = Eigen::VectorXd::Constant(layout.size(), kInfinity);
  problem.prior_deviation[layout.lag()] = sample_step_s(stretches) / std::sqrt(3.0);
  const double step_s = sample_step_s(stretches);
  problem.expected_noise = [&](const Eigen::VectorXd& theta) {
    return filtered_noise(9, averaged, step_s, std::exp(theta[layout.log_tau()]));
  };
  const NonlinearFit fit = fit_nonlinear(problem, start);

  const double tau_s = std::exp(fit.theta[layout.log_tau()]);
  const Eigen::VectorXd starts = fit.theta.tail(static_cast<Eigen::Index>(stretches.size()));
  const auto [low, high] = range_of(stretches, tau_s, starts);
  const Eigen::Index size = layout.coefficients();
  const Eigen::MatrixXd change = change_of_origin(size, scale.middle, scale.half, options.reference_degc);
  const Eigen::MatrixXd covariance = change * fit.covariance.topLeftCorner(size, size) * change.transpose();
  const Eigen::VectorXd coefficients =
      options.known ? options.known->coefficients_hz() : Eigen::VectorXd(change * fit.theta.head(size));
  const double reference_degc = options.known ? options.known->reference_degc() : options.reference_degc;
  double p_value = std::numeric_limits<double>::quiet_NaN();
  if (size > 0) {
    const double score = std::abs(fit.theta[size - 1]) / fit.standard_error(size - 1);
    p_value = 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), score));
  }
  return {FrequencyPolynomial(coefficients, reference_degc, low, high),
          size > 0 ? Eigen::VectorXd(covariance.diagonal().cwiseSqrt())
                   : Eigen::VectorXd(Eigen::VectorXd::Zero(coefficients.size())),
          covariance,
          tau_s,
          tau_s * fit.standard_error(layout.log_tau()),
          fit.theta[layout.lag()],
          fit.standard_error(layout.lag()),
          starts,
          fit.noise,
          std::sqrt(fit.residual.cwiseProduct(simulation.hz_per_degc()).squaredNorm() /
                    static_cast<double>(fit.residual.size())),
          fit.residual.size(),
          averaged,
          p_value};
}

Eigen::Index order_of_recordings(const std::vector<ThermalStretch>& stretches, double reference_degc,
                                 Eigen::Index most) {
  std::vector<double> p_values;
  for (Eigen::Index order = 2; order <= most + 2; ++order)
    p_values.push_back(fit_thermal(stretches, {order, reference_degc, std::nullopt}).highest_order_p);
  Eigen::Index chosen = 1;
  while (chosen < most && (p_values[static_cast<std::size_t>(chosen - 1)] < kOrderLevel ||
                           p_values[static_cast<std::size_t>(chosen)] < kOrderLevel))
    ++chosen;
  return chosen;
}

}  // namespace hemi::calibration

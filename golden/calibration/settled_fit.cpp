// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/settled_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "golden/calibration/linear_fit.hpp"
#include "golden/calibration/nonlinear_fit.hpp"

namespace hemi::calibration {
namespace {

constexpr Eigen::Index kRows = 1500;
constexpr double kLargestErrorDegc = 0.02;
constexpr double kSameSoakDegc = 1.0;

// theta: ln(tau), then settled frequency less p(T_h) and T[0] of each hold.
class Approaches {
 public:
  Approaches(const std::vector<ThermalStretch>& stretches, const std::vector<Hold>& holds,
             const RowBlocks& blocks, const FrequencyPolynomial& polynomial, double lag_s)
      : stretches_(stretches), holds_(holds), blocks_(blocks), polynomial_(polynomial), lag_s_(lag_s) {}

  void operator()(const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian) const {
    residual = Eigen::VectorXd::Zero(blocks_.rows());
    jacobian = Eigen::MatrixXd::Zero(blocks_.rows(), theta.size());
    for (std::size_t h = 0; h < holds_.size(); ++h) {
      const Hold& hold = holds_[h];
      const ThermalStretch& stretch = stretches_[hold.stretch];
      const auto column = 1 + 2 * static_cast<Eigen::Index>(h);
      const FilterResponse t =
          thermal_filter(stretch, hold.begin, hold.count, std::exp(theta[0]), theta[column + 1]);
      for (Eigen::Index i = 0; i < hold.count; ++i) {
        const Eigen::Index b = blocks_.block(h, i);
        if (b < 0) continue;
        const double now = t.temperature_degc[i];
        const double degc = now - lag_s_ * (stretch.case_degc[hold.begin + i] - now) / std::exp(theta[0]);
        const double per_degc = polynomial_.slope_hz_per_degc(degc);
        residual[b] += stretch.frequency_hz[hold.begin + i] - polynomial_.frequency_hz(degc) - theta[column];
        jacobian(b, 0) += per_degc * t.per_log_tau[i];
        jacobian(b, column) += 1.0;
        jacobian(b, column + 1) += per_degc * t.per_start[i];
      }
    }
    for (Eigen::Index b = 0; b < blocks_.rows(); ++b) {
      const double weight = 1.0 / static_cast<double>(blocks_.used(b));
      residual[b] *= weight;
      jacobian.row(b) *= weight;
    }
  }

 private:
  const std::vector<ThermalStretch>& stretches_;
  const std::vector<Hold>& holds_;
  const RowBlocks& blocks_;
  const FrequencyPolynomial& polynomial_;
  double lag_s_;
};

double first_frequency(const ThermalStretch& stretch, const Hold& hold) {
  for (Eigen::Index i = hold.begin; i < hold.begin + hold.count; ++i)
    if (!std::isnan(stretch.frequency_hz[i])) return stretch.frequency_hz[i];
  return std::numeric_limits<double>::quiet_NaN();
}

double start_degc(const ThermalStretch& stretch, const Hold& hold, const FrequencyPolynomial& polynomial) {
  const double offset_hz = first_frequency(stretch, hold) - polynomial.frequency_hz(hold.case_degc);
  const double guess = hold.case_degc + offset_hz / polynomial.slope_hz_per_degc(hold.case_degc);
  return std::isfinite(guess) ? std::clamp(guess, hold.case_degc - 100.0, hold.case_degc + 100.0)
                              : hold.case_degc;
}

// Holds that are the same soak, as indices; in order of temperature.
std::vector<std::vector<std::size_t>> soaks_of(const std::vector<Hold>& holds) {
  std::vector<std::size_t> order(holds.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return holds[a].case_degc < holds[b].case_degc; });
  std::vector<std::vector<std::size_t>> soaks;
  for (const std::size_t i : order) {
    if (soaks.empty() || holds[i].case_degc - holds[soaks.back().front()].case_degc > kSameSoakDegc)
      soaks.emplace_back();
    soaks.back().push_back(i);
  }
  return soaks;
}

// Frequencies of the soak made missing; stretches that hold no other row are dropped.
std::vector<ThermalStretch> without(const std::vector<ThermalStretch>& stretches,
                                    const std::vector<Hold>& holds, const std::vector<std::size_t>& soak) {
  std::vector<ThermalStretch> rest = stretches;
  for (const std::size_t h : soak) {
    Eigen::Index begin = 0, end = stretches[holds[h].stretch].time_s.size();
    for (const Hold& other : holds) {
      if (other.stretch != holds[h].stretch) continue;
      if (other.begin < holds[h].begin) begin = std::max(begin, other.begin + other.count);
      if (other.begin > holds[h].begin) end = std::min(end, other.begin);
    }
    rest[holds[h].stretch]
        .frequency_hz.segment(begin, end - begin)
        .setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  std::erase_if(rest, [](const ThermalStretch& s) { return s.frequency_hz.array().isNaN().all(); });
  return rest;
}

}  // namespace

SettledPoints SettledFit::points() const {
  SettledPoints points;
  points.temperature_degc.resize(static_cast<Eigen::Index>(values.size()));
  points.frequency_hz.resize(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    points.temperature_degc[static_cast<Eigen::Index>(i)] = values[i].hold.case_degc;
    points.frequency_hz[static_cast<Eigen::Index>(i)] = values[i].frequency_hz;
  }
  return points;
}

SettledFit fit_settled(const std::vector<ThermalStretch>& stretches, const std::vector<Hold>& holds,
                       const FrequencyPolynomial& polynomial, double time_constant_s, double lag_s) {
  SettledFit result;
  if (holds.empty()) return result;
  std::vector<RowBlocks::Range> ranges;
  Eigen::Index total = 0;
  for (const Hold& hold : holds) {
    ranges.push_back({hold.stretch, hold.begin, hold.count});
    total += hold.count;
  }
  const Eigen::Index averaged = block_length(total, kRows);
  const double step_s = sample_step_s(stretches);
  const RowBlocks blocks(stretches, ranges, averaged);
  NonlinearProblem problem;
  problem.evaluate = Approaches(stretches, holds, blocks, polynomial, lag_s);
  for (std::size_t i = 0; i < blocks.begins().size(); ++i)
    problem.segments.push_back({blocks.begins()[i], blocks.counts()[i]});
  Eigen::VectorXd start(1 + 2 * static_cast<Eigen::Index>(holds.size()));
  start[0] = std::log(time_constant_s);
  problem.names.emplace_back("time constant");
  for (std::size_t h = 0; h < holds.size(); ++h) {
    const auto column = 1 + 2 * static_cast<Eigen::Index>(h);
    start[column] = 0.0;
    start[column + 1] = start_degc(stretches[holds[h].stretch], holds[h], polynomial);
    problem.names.push_back(fmt::format("settled frequency at {:.2f} degC", holds[h].case_degc));
    problem.names.push_back(fmt::format("T[0] at {:.2f} degC", holds[h].case_degc));
  }
  problem.prior_mean = Eigen::VectorXd::Zero(start.size());
  problem.prior_deviation = Eigen::VectorXd::Constant(start.size(), std::numeric_limits<double>::infinity());
  problem.expected_noise = [&](const Eigen::VectorXd& theta) {
    return filtered_noise(9, averaged, step_s, std::exp(theta[0]));
  };
  const NonlinearFit fit = fit_nonlinear(problem, start);
  const double tau_s = std::exp(fit.theta[0]);
  result.time_constant_s = tau_s;
  result.time_constant_error_s = tau_s * fit.standard_error(0);
  for (std::size_t h = 0; h < holds.size(); ++h) {
    const auto column = 1 + 2 * static_cast<Eigen::Index>(h);
    const Hold& hold = holds[h];
    const FilterResponse t =
        thermal_filter(stretches[hold.stretch], hold.begin, hold.count, tau_s, fit.theta[column + 1]);
    const double at_rest_hz = polynomial.frequency_hz(hold.case_degc);
    const double error_hz = fit.standard_error(column);
    const double per_degc = std::abs(polynomial.slope_hz_per_degc(hold.case_degc));
    const SettledValue value{hold, at_rest_hz + fit.theta[column], error_hz,
                             at_rest_hz - polynomial.frequency_hz(t.temperature_degc[hold.count - 1]),
                             std::hypot(error_hz / per_degc, hold.case_error_degc)};
    if (value.temperature_error_degc <= kLargestErrorDegc) {
      result.values.push_back(value);
      continue;
    }
    result.refused.push_back(
        {hold.stretch, hold.from_s, hold.to_s, hold.case_degc,
         fmt::format(
             "its settled value is known to {:.3f} degC only ({:.2g} Hz to go after {:.1f} time constants)",
             value.temperature_error_degc, value.to_go_hz, (hold.to_s - hold.from_s) / tau_s)});
  }
  return result;
}

std::vector<SoakError> leave_one_soak_out(const std::vector<ThermalStretch>& stretches,
                                          const std::vector<Hold>& holds, Eigen::Index order,
                                          double reference_degc) {
  std::vector<SoakError> errors;
  const auto soaks = soaks_of(holds);
  for (std::size_t s = 0; s < soaks.size(); ++s) {
    const bool end = s == 0 || s + 1 == soaks.size();
    const auto unseen = [&](std::size_t h) {
      return std::find(soaks[s].begin(), soaks[s].end(), h) != soaks[s].end();
    };
    std::optional<ThermalFit> rest;
    std::optional<SettledFit> settled;
    try {
      rest = fit_thermal(without(stretches, holds, soaks[s]), {order, reference_degc, std::nullopt});
      settled = fit_settled(stretches, holds, rest->polynomial, rest->time_constant_s, rest->lag_s);
    } catch (const std::exception&) {
      // Too little is left without this soak: its line stays open.
    }
    for (std::size_t h = 0; h < holds.size(); ++h) {
      if (!unseen(h)) continue;
      SoakError error{holds[h].case_degc, end, std::numeric_limits<double>::quiet_NaN()};
      for (const SettledValue& value : settled ? settled->values : std::vector<SettledValue>()) {
        if (value.hold.stretch != holds[h].stretch || value.hold.begin != holds[h].begin) continue;
        try {
          error.error_degc = rest->polynomial.temperature_degc(value.frequency_hz) - holds[h].case_degc;
        } catch (const std::domain_error&) {
          // f(T) of the rest turns round before it gets here.
        }
      }
      errors.push_back(error);
    }
  }
  return errors;
}

}  // namespace hemi::calibration

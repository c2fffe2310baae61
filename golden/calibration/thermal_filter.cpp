// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/thermal_filter.hpp"

#include <algorithm>
#include <cmath>

namespace hemi::calibration {

FilterResponse thermal_filter(const ThermalStretch& stretch, Eigen::Index begin, Eigen::Index count,
                              double tau_s, double start_degc) {
  FilterResponse out{Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  double temperature = start_degc, per_tau = 0.0, per_start = 1.0;
  double last_step_s = -1.0, stays = 1.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (i > 0) {
      const double step_s = stretch.time_s[begin + i] - stretch.time_s[begin + i - 1];
      // Equal steps but for the printed digits of the time: the exponential is worth remembering.
      if (step_s != last_step_s) stays = std::exp(-step_s / tau_s);
      last_step_s = step_s;
      const double ahead = stretch.case_degc[begin + i] - temperature;
      per_tau = stays * per_tau - stays * step_s / tau_s * ahead;
      temperature += (1.0 - stays) * ahead;
      per_start *= stays;
    }
    out.temperature_degc[i] = temperature;
    out.per_log_tau[i] = per_tau;
    out.per_start[i] = per_start;
  }
  return out;
}

RowBlocks::RowBlocks(const std::vector<ThermalStretch>& stretches, const std::vector<Range>& ranges,
                     Eigen::Index length) {
  for (std::size_t r = 0; r < ranges.size(); ++r) {
    const Range& range = ranges[r];
    const auto& f = stretches[range.stretch].frequency_hz;
    block_of_.emplace_back(static_cast<std::size_t>(range.count), -1);
    bool open = false;
    for (Eigen::Index first = 0; first + length <= range.count; first += length) {
      const auto part = f.segment(range.begin + first, length).array();
      const Eigen::Index used = length - part.isNaN().count();
      if (2 * used < length || used == 0) {
        open = false;
        continue;
      }
      if (!open) {
        begins_.push_back(rows());
        counts_.push_back(0);
      }
      open = true;
      ++counts_.back();
      for (Eigen::Index i = 0; i < length; ++i) {
        if (!std::isnan(part[i])) block_of_[r][static_cast<std::size_t>(first + i)] = rows();
      }
      used_.push_back(used);
      range_of_.push_back(r);
    }
  }
}

double sample_step_s(const std::vector<ThermalStretch>& stretches) {
  double seconds = 0.0, steps = 0.0;
  for (const auto& s : stretches) {
    seconds += s.time_s[s.time_s.size() - 1] - s.time_s[0];
    steps += static_cast<double>(s.time_s.size() - 1);
  }
  return seconds / std::max(steps, 1.0);
}

Eigen::VectorXd filtered_noise(Eigen::Index count, Eigen::Index length, double step_s, double tau_s) {
  const double a = std::exp(-step_s / tau_s);
  const auto n = static_cast<double>(length);
  const double power = std::pow(a, n);
  const double sum = (1.0 - power) / (1.0 - a);
  Eigen::VectorXd r(count);
  r[0] = (n * (1.0 + a) / (1.0 - a) - 2.0 * a * (1.0 - power) / ((1.0 - a) * (1.0 - a))) / (n * n);
  for (Eigen::Index k = 1; k < count; ++k)
    r[k] = std::pow(a, static_cast<double>(k - 1) * n + 1.0) * sum * sum / (n * n);
  return r / r[0];
}

Eigen::Index block_length(Eigen::Index total, Eigen::Index rows) {
  return std::max<Eigen::Index>(1, total / rows);
}

}  // namespace hemi::calibration

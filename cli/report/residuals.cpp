// SPDX-License-Identifier: Apache-2.0
#include "cli/report/residuals.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "golden/calibration/allan.hpp"

namespace hemi::report {
namespace {

double usual_step(std::span<const double> time_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

Eigen::VectorXd rows_of(const Run& run, std::span<const double> values) {
  return Eigen::VectorXd::Map(values.data() + run.first, static_cast<Eigen::Index>(run.rows));
}

}  // namespace

Run longest_run(std::span<const double> time_s, std::span<const double> values) {
  const double longest_step = 1.5 * usual_step(time_s);
  Run best;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= values.size(); ++i) {
    const bool missing = i == values.size() || std::isnan(values[i]);
    if (!missing && (i == first || time_s[i] - time_s[i - 1] <= longest_step)) continue;
    if (i - first > best.rows) best = {first, i - first, 0.0};
    first = missing ? i + 1 : i;
  }
  if (best.rows > 1)
    best.step_s =
        (time_s[best.first + best.rows - 1] - time_s[best.first]) / static_cast<double>(best.rows - 1);
  return best;
}

std::optional<Series> allan_series(const std::string& name, std::span<const double> time_s,
                                   std::span<const double> values) {
  const Run run = longest_run(time_s, values);
  if (run.rows < 16 || !(run.step_s > 0.0)) return std::nullopt;
  Series series{.name = name};
  for (const auto& p : calibration::allan_deviation(rows_of(run, values), run.step_s).points) {
    series.points.x.push_back(p.tau_s);
    series.points.y.push_back(p.deviation);
    series.lower.push_back(p.lower);
    series.upper.push_back(p.upper);
  }
  series.points.samples = series.points.x.size();
  return series;
}

std::optional<Series> spectrum_series(const std::string& name, std::span<const double> time_s,
                                      std::span<const double> values) {
  const Run run = longest_run(time_s, values);
  if (run.rows < 64 || !(run.step_s > 0.0)) return std::nullopt;
  const Eigen::VectorXd all = rows_of(run, values);
  // Eight segments that overlap by half take 4.5 lengths.
  Eigen::Index length = 8;
  while (length < 8192 && 2 * length * 9 / 2 <= all.size()) length *= 2;
  const Eigen::ArrayXd window =
      0.5 - 0.5 * (Eigen::ArrayXd::LinSpaced(length, 0.0, static_cast<double>(length - 1)) *
                   (2.0 * std::numbers::pi / static_cast<double>(length)))
                      .cos();
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::ArrayXd power = Eigen::ArrayXd::Zero(length / 2 + 1);
  double segments = 0.0;
  for (Eigen::Index at = 0; at + length <= all.size(); at += length / 2, segments += 1.0) {
    const Eigen::VectorXd part = all.segment(at, length);
    const Eigen::VectorXd windowed = ((part.array() - part.mean()) * window).matrix();
    Eigen::VectorXcd transform;
    fft.fwd(transform, windowed);
    power += transform.array().abs2();
  }
  // One-sided, so that its integral over frequency is the variance.
  power *= 2.0 * run.step_s / (window.square().sum() * segments);
  std::vector<double> hertz, density;
  for (Eigen::Index k = 1; k <= length / 2; ++k) {
    hertz.push_back(static_cast<double>(k) / (static_cast<double>(length) * run.step_s));
    density.push_back(std::sqrt(k == length / 2 ? 0.5 * power[k] : power[k]));
  }
  return Series::line(name, hertz, density);
}

}  // namespace hemi::report

// SPDX-License-Identifier: Apache-2.0
#include "cli/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace hemi::cli {
namespace {

constexpr double kRingDown = 3.0;  // fall of a ring-down's logarithm over its scatter

/// Straight line through log amplitude, all outputs alike: what scatters a ring-down is mostly neighbouring
/// lines, which shrink with it. Outputs overlap by half, so n of them count as n / 2.
void fit_decay(const std::vector<double>& t, const std::vector<double>& a, RunSummary& s) {
  const auto n = static_cast<double>(t.size());
  double t_mean = 0, y_mean = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    t_mean += t[i] / n;
    y_mean += std::log(a[i]) / n;
  }
  double tt = 0, ty = 0, yy = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double y = std::log(a[i]) - y_mean;
    tt += (t[i] - t_mean) * (t[i] - t_mean);
    ty += (t[i] - t_mean) * y;
    yy += y * y;
  }
  const double slope = ty / tt;
  const double squares = yy - slope * ty;
  const double error = std::sqrt(squares / tt / (0.5 * n));
  if (!(slope < -3.0 * error)) return;
  // Under an amplitude loop the line's slope means nothing: such an amplitude scatters by more than it falls.
  if (!(slope * (t.front() - t.back()) > kRingDown * std::sqrt(squares / n))) return;
  s.damping_time_s = -1.0 / slope;
  s.quality_factor = std::numbers::pi * s.frequency_hz * *s.damping_time_s;
  s.quality_factor_error = *s.quality_factor * error / -slope;
}

double mean(const std::vector<double>& v, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += v[i];
  return sum / static_cast<double>(end - begin);
}

/// Least squares on the phase that the outputs sum to: parabolic weights 6 k (n + 1 - k) / (n (n + 1) (n +
/// 2)).
double phase_slope(const std::vector<double>& f, std::size_t begin, std::size_t end) {
  const auto n = static_cast<double>(end - begin);
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const auto k = static_cast<double>(i - begin + 1);
    sum += k * (n + 1 - k) * f[i];
  }
  return 6 * sum / (n * (n + 1) * (n + 2));
}

}  // namespace

RunSummary summarise_capture(const recording::Recording& output, double from_s, double to_s) {
  const auto& time = output.find("time_s")->values;
  const auto& frequency = output.find("frequency_hz")->values;
  const auto& amplitude = output.find("amplitude")->values;
  const auto& status = output.find("status")->values;
  RunSummary s;
  std::vector<double> t, f, a;
  std::size_t window = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] < from_s || time[i] > to_s) continue;
    ++window;
    if (!locked(status[i]) || !(amplitude[i] > 0)) continue;
    t.push_back(time[i]);
    f.push_back(frequency[i]);
    a.push_back(amplitude[i]);
  }
  s.outputs = t.size();
  s.locked_share = window > 0 ? static_cast<double>(t.size()) / static_cast<double>(window) : 0.0;
  if (t.size() < 20) return s;
  const std::size_t quarter = t.size() / 4;
  s.first_s = t.front();
  s.last_s = t.back();
  s.frequency_hz = phase_slope(f, 0, f.size());
  s.start_hz = phase_slope(f, 0, quarter);
  s.end_hz = phase_slope(f, f.size() - quarter, f.size());
  s.drift_ppm = (s.end_hz / s.start_hz - 1.0) * 1e6;
  s.start_amplitude = mean(a, 0, quarter);
  s.end_amplitude = mean(a, a.size() - quarter, a.size());
  fit_decay(t, a, s);
  return s;
}

std::string to_text(const RunSummary& s) {
  if (s.frequency_hz == 0.0) {
    return "not locked: fewer than 20 usable outputs; give --frequency within a few Hz of the resonator\n";
  }
  std::string text = fmt::format("locked for {:.1f} % of the window; {} outputs from {:.3f} s to {:.3f} s\n",
                                 100.0 * s.locked_share, s.outputs, s.first_s, s.last_s);
  text += fmt::format("frequency  {:.6f} Hz, from {:.6f} to {:.6f} Hz ({:+.2f} ppm)\n", s.frequency_hz,
                      s.start_hz, s.end_hz, s.drift_ppm);
  text += fmt::format("amplitude  {:.6f} to {:.6f} (1 = 0.8 of full scale)\n", s.start_amplitude,
                      s.end_amplitude);
  if (s.quality_factor) {
    text += fmt::format("quality factor {:.0f} +- {:.0f}, damping time {:.4f} s\n", *s.quality_factor,
                        *s.quality_factor_error, *s.damping_time_s);
  }
  return text;
}

recording::Json to_json(const RunSummary& s) {
  recording::Json json;
  json["outputs"] = s.outputs;
  json["locked_share"] = s.locked_share;
  json["time_s"] = {s.first_s, s.last_s};
  json["frequency_hz"] = s.frequency_hz;
  json["start_hz"] = s.start_hz;
  json["end_hz"] = s.end_hz;
  json["drift_ppm"] = s.drift_ppm;
  json["amplitude"] = {s.start_amplitude, s.end_amplitude};
  if (s.quality_factor) {
    json["damping_time_s"] = *s.damping_time_s;
    json["quality_factor"] = *s.quality_factor;
    json["quality_factor_error"] = *s.quality_factor_error;
  }
  return json;
}

}  // namespace hemi::cli

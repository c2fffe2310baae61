// SPDX-License-Identifier: Apache-2.0
// Drive and quadrature over the resonator's temperature, amplitude set point, noise densities.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "cli/calibrate.hpp"
#include "golden/calibration/drift_terms.hpp"
#include "golden/calibration/noise_parts.hpp"
#include "golden/calibration/voltage_fit.hpp"

namespace hemi::cli {
namespace {

using hemi::calibration::RowRange;

constexpr double reference_degc = 20.0;
/// Slower than that, what is left of a channel is drift and errors of the model.
constexpr double longest_tau_s = 1000.0;

/// Samples of all recordings one after another.
struct Joined {
  Eigen::VectorXd temperature_degc;
  Eigen::VectorXd value;
  std::vector<RowRange> segments;
};

void append(Eigen::VectorXd& to, const Eigen::VectorXd& from) {
  const Eigen::Index size = to.size();
  to.conservativeResize(size + from.size());
  to.tail(from.size()) = from;
}

/// Resonator temperature from the frequency; NaN where f(T) cannot be inverted.
std::vector<double> temperatures(const recording::Recording& recording,
                                 const hemi::calibration::FrequencyPolynomial& polynomial) {
  std::vector<double> out;
  for (const double f : recording.find("frequency_hz")->values) {
    out.push_back(std::numeric_limits<double>::quiet_NaN());
    if (std::isnan(f)) continue;
    try {
      out.back() = polynomial.temperature_degc(f);
    } catch (const std::domain_error&) {
      // Not a frequency of this resonator: the row is not used.
    }
  }
  return out;
}

/// A command per unit of amplitude, less what was put on it deliberately.
Joined joined_command(const std::vector<recording::Recording>& recordings, const char* name, const char* trim,
                      const hemi::calibration::FrequencyPolynomial& polynomial) {
  Joined all;
  for (const auto& recording : recordings) {
    const auto* channel = recording.find(name);
    if (channel == nullptr || recording.find("frequency_hz") == nullptr) continue;
    const auto degc = temperatures(recording, polynomial);
    const auto* amplitude = recording.find("amplitude");
    const auto offset = recording.or_zero(trim);
    std::vector<double> value = channel->values;
    for (std::size_t i = 0; i < value.size(); ++i)
      value[i] = (value[i] - offset[i]) / (amplitude != nullptr ? amplitude->values[i] : 1.0);
    const Eigen::Index before = all.value.size();
    for (const RowRange& range : complete_rows(recording, {&degc, &value}))
      all.segments.push_back({before + range.begin, range.count});
    append(all.temperature_degc, Eigen::VectorXd::Map(degc.data(), static_cast<Eigen::Index>(degc.size())));
    append(all.value, Eigen::VectorXd::Map(value.data(), static_cast<Eigen::Index>(value.size())));
  }
  return all;
}

void put_noise(const char* key, const hemi::calibration::NoiseParts& parts, Calibration& calibration) {
  calibration.model.noise[key] = {parts.white, parts.flicker, parts.random_walk, parts.differenced};
  calibration.text += fmt::format("noise {:<22} white {:.3g}", key, parts.white);
  if (parts.flicker > 0.0) calibration.text += fmt::format(", flicker {:.3g}", parts.flicker);
  if (parts.random_walk > 0.0) calibration.text += fmt::format(", random walk {:.3g}", parts.random_walk);
  if (parts.differenced > 0.0) calibration.text += fmt::format(", differenced {:.3g}", parts.differenced);
  calibration.text += fmt::format(" (to {:.4g} s)\n", parts.to_tau_s);
  calibration.json["noise"][key] = {{"white", parts.white},
                                    {"flicker", parts.flicker},
                                    {"random_walk", parts.random_walk},
                                    {"differenced", parts.differenced}};
}

void noise_of(const char* key, const Eigen::VectorXd& residual, const std::vector<RowRange>& segments,
              double interval_s, Calibration& calibration) {
  try {
    put_noise(key, hemi::calibration::fit_noise_parts(residual, segments, interval_s, longest_tau_s),
              calibration);
  } catch (const std::invalid_argument& error) {
    calibration.leave_out(fmt::format("noise.{}", key), error.what());
  }
}

void calibrate_command(const std::vector<recording::Recording>& recordings, const char* name,
                       const char* trim, const char* noise_key, std::optional<recording::VoltageModel>& part,
                       Calibration& calibration) {
  const std::string short_name = std::string(name).substr(0, std::string(name).find('_'));
  const Joined all = joined_command(recordings, name, trim, frequency_polynomial(calibration.model));
  if (all.segments.empty()) {
    calibration.leave_out(short_name, fmt::format("no recording has {} and frequency_hz", name));
    return;
  }
  try {
    const auto fit = hemi::calibration::fit_over_temperature(all.temperature_degc, all.value, all.segments,
                                                             reference_degc);
    part = recording::VoltageModel{
        reference_degc, {fit.coefficients.data(), fit.coefficients.data() + fit.coefficients.size()}};
    calibration.text +=
        fmt::format("{} over T - {} degC, order {}:", name, reference_degc, fit.coefficients.size() - 1);
    auto& json = calibration.json[short_name];
    for (Eigen::Index k = 0; k < fit.coefficients.size(); ++k) {
      calibration.text += fmt::format("  {:+.6g} +- {:.1g}", fit.coefficients[k], fit.standard_errors[k]);
      json["coefficients_v"].push_back(fit.coefficients[k]);
      json["standard_errors_v"].push_back(fit.standard_errors[k]);
    }
    calibration.text += " V/degC^i\n";
    Eigen::VectorXd residual = all.value;
    for (Eigen::Index i = 0; i < residual.size(); ++i) residual[i] -= fit.value(all.temperature_degc[i]);
    noise_of(noise_key, residual, all.segments, 1.0 / recordings.front().sample_rate_hz, calibration);
  } catch (const std::exception& error) {
    calibration.leave_out(short_name, error.what());
  }
}

double median_of(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// Median of the amplitude, so that deliberate steps of it (an excitation) do not move the set point, and the
/// noise of the rows that lie within six standard deviations of it.
void calibrate_amplitude(const std::vector<recording::Recording>& recordings, Calibration& calibration) {
  std::vector<double> values, steps;
  for (const auto& recording : recordings) {
    const auto* channel = recording.find("amplitude");
    if (channel == nullptr) continue;
    for (std::size_t i = 0; i < channel->values.size(); ++i) {
      if (std::isnan(channel->values[i])) continue;
      values.push_back(channel->values[i]);
      if (i > 0 && !std::isnan(channel->values[i - 1]))
        steps.push_back(std::abs(channel->values[i] - channel->values[i - 1]));
    }
  }
  if (steps.empty()) {
    calibration.leave_out("amplitude", fmt::format("no recording has it; the set point stays {}",
                                                   calibration.model.amplitude_setpoint));
    return;
  }
  const double setpoint = median_of(values);
  // The median of |x| is 0.6745 standard deviations, and a difference has twice the variance.
  const double deviation = median_of(steps) / (0.6745 * std::numbers::sqrt2);
  Joined all;
  for (const auto& recording : recordings) {
    const auto* channel = recording.find("amplitude");
    if (channel == nullptr) continue;
    std::vector<double> near = channel->values;
    for (double& a : near)
      if (!(std::abs(a - setpoint) <= 6.0 * deviation)) a = std::numeric_limits<double>::quiet_NaN();
    const Eigen::Index before = all.value.size();
    for (const RowRange& range : complete_rows(recording, {&near}))
      all.segments.push_back({before + range.begin, range.count});
    append(all.value, Eigen::VectorXd::Map(near.data(), static_cast<Eigen::Index>(near.size())));
  }
  calibration.model.amplitude_setpoint = setpoint;
  calibration.json["amplitude"]["setpoint"] = setpoint;
  calibration.text += fmt::format("amplitude set point {:.7g}, the median\n", setpoint);
  noise_of("amplitude_rthz", all.value, all.segments, 1.0 / recordings.front().sample_rate_hz, calibration);
}

/// The frequency's own noise: what free simulation leaves, less what the thermometer's noise does through the
/// filter, f' s sqrt(2 d) / (2 pi tau) above its corner, which looks like a random walk of that density.
void frequency_noise(const ThermalStudy& study, Calibration& calibration) {
  const auto& fit = *study.fit;
  Eigen::VectorXd residual;
  std::vector<RowRange> segments;
  double case_variance = 0.0, rows = 0.0;
  for (std::size_t s = 0; s < study.stretches.size(); ++s) {
    const auto& stretch = study.stretches[s];
    Eigen::VectorXd left = fit.temperature_degc(study.stretches, s);
    for (Eigen::Index i = 0; i < left.size(); ++i) {
      left[i] = stretch.frequency_hz[i] - fit.polynomial.frequency_hz(left[i]);
      if (std::isnan(left[i])) continue;
      if (i == 0 || std::isnan(left[i - 1])) segments.push_back({residual.size() + i, 0});
      ++segments.back().count;
    }
    append(residual, left);
  }
  for (const auto& hold : study.holds.used) {
    const double noise = hemi::calibration::reading_noise(
        study.stretches[hold.stretch].case_degc.segment(hold.begin, hold.count));
    case_variance += noise * noise * static_cast<double>(hold.count);
    rows += static_cast<double>(hold.count);
  }
  const double step_s = hemi::calibration::sample_step_s(study.stretches);
  try {
    auto parts = hemi::calibration::fit_noise_parts(residual, segments, step_s, longest_tau_s);
    if (rows > 0.0) {
      const double noise_degc = std::sqrt(case_variance / rows);
      calibration.model.noise["case_temp_degc"] = {noise_degc, 0.0, 0.0, 0.0};
      calibration.json["noise"]["case_temp_degc"] = noise_degc;
      calibration.text += fmt::format("noise case_temp_degc         {:.3g} a reading\n", noise_degc);
      const double middle = 0.5 * (fit.polynomial.min_degc() + fit.polynomial.max_degc());
      const double through = std::abs(fit.polynomial.slope_hz_per_degc(middle)) * noise_degc *
                             std::sqrt(2.0 * step_s) / (2.0 * std::numbers::pi * fit.time_constant_s);
      calibration.text +=
          fmt::format("  through the filter it is a random walk of {:.3g} Hz/rtHz at 1 Hz, of {:.3g} found\n",
                      through, parts.random_walk);
      // Within what the densities are known to, all of it is the thermometer's.
      const double own = parts.random_walk * parts.random_walk - through * through;
      parts.random_walk = own > 0.5 * through * through ? std::sqrt(own) : 0.0;
    }
    put_noise("frequency_hz_rthz", parts, calibration);
  } catch (const std::invalid_argument& error) {
    calibration.leave_out("noise.frequency_hz_rthz", error.what());
  }
}

void rate_noise(const DriftData& drift, Calibration& calibration) {
  Eigen::VectorXd residual = drift.samples.rate_dph;
  const auto& bias = *calibration.model.bias;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    for (std::size_t k = 0; k < hemi::calibration::kDriftTermCount; ++k)
      residual[i] -= bias.terms_dph[k] *
                     hemi::calibration::kDriftTerms[k].value(
                         drift.samples.frequency_hz[i] - bias.reference_hz, drift.samples.slope_hz_per_s[i]);
  }
  noise_of("rate_dph_rthz", residual, drift.samples.segments, drift.interval_s, calibration);
}

}  // namespace

std::vector<RowRange> complete_rows(const recording::Recording& recording,
                                    const std::vector<const std::vector<double>*>& channels) {
  std::vector<RowRange> ranges;
  std::size_t gap = 0;
  bool open = false;
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    if (gap < recording.gaps.size() && recording.gaps[gap].after_row + 1 == i) {
      open = false;
      ++gap;
    }
    bool whole = true;
    for (const auto* channel : channels) whole = whole && std::isfinite((*channel)[i]);
    if (whole && !open) ranges.push_back({static_cast<Eigen::Index>(i), 0});
    if (whole) ++ranges.back().count;
    open = whole;
  }
  return ranges;
}

void calibrate_channels(const std::vector<recording::Recording>& recordings,
                        const std::optional<ThermalStudy>& thermal, const std::optional<DriftData>& drift,
                        Calibration& calibration) {
  auto& model = calibration.model;
  calibrate_amplitude(recordings, calibration);
  calibrate_command(recordings, "drive_v", "", "drive_v_rthz", model.drive, calibration);
  calibrate_command(recordings, "quadrature_v", "quadrature_trim_v", "quadrature_v_rthz", model.quadrature,
                    calibration);
  if (thermal)
    frequency_noise(*thermal, calibration);
  else
    calibration.leave_out("noise.frequency_hz_rthz", "no recording has case_temp_degc and frequency_hz");
  if (drift) rate_noise(*drift, calibration);
}

}  // namespace hemi::cli

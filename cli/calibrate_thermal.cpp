// SPDX-License-Identifier: Apache-2.0
// f(T) and the thermal time constant from chamber recordings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cli/calibrate.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "golden/calibration/inverse_polynomial.hpp"
#include "golden/calibration/order_study.hpp"

namespace hemi::cli {
namespace {

using hemi::calibration::ThermalStretch;
using recording::InputError;
using recording::Recording;

// A case temperature that is missing for longer is not bridged by a straight line: a new stretch begins.
constexpr double longest_bridge_s = 60.0;
constexpr double least_stretch_s = 600.0;

bool has_thermal_channels(const Recording& recording) {
  return recording.find("case_temp_degc") != nullptr && recording.find("frequency_hz") != nullptr;
}

/// Case readings [first, last] of which both ends are there, the missing ones between them bridged.
ThermalStretch bridged(const Recording& recording, std::size_t first, std::size_t last) {
  const auto& time = recording.find("time_s")->values;
  const auto& housing = recording.find("case_temp_degc")->values;
  const auto& frequency = recording.find("frequency_hz")->values;
  const auto rows = static_cast<Eigen::Index>(last - first + 1);
  ThermalStretch stretch{Eigen::VectorXd::Map(&time[first], rows),
                         Eigen::VectorXd::Map(&housing[first], rows),
                         Eigen::VectorXd::Map(&frequency[first], rows)};
  Eigen::Index known = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (std::isnan(stretch.case_degc[i])) continue;
    for (Eigen::Index k = known + 1; k < i; ++k) {
      const double share =
          (stretch.time_s[k] - stretch.time_s[known]) / (stretch.time_s[i] - stretch.time_s[known]);
      stretch.case_degc[k] =
          stretch.case_degc[known] + share * (stretch.case_degc[i] - stretch.case_degc[known]);
    }
    known = i;
  }
  return stretch;
}

void add_stretches(const Recording& recording, std::size_t which, const CalibrateOptions& options,
                   ThermalStudy& study) {
  const auto& time = recording.find("time_s")->values;
  const auto& housing = recording.find("case_temp_degc")->values;
  std::optional<std::size_t> first, last;
  const auto close = [&] {
    if (first && time[*last] - time[*first] >= least_stretch_s) {
      study.stretches.push_back(bridged(recording, *first, *last));
      study.recording_of.push_back(which);
      study.first_row.push_back(static_cast<Eigen::Index>(*first));
    }
    first.reset();
  };
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (std::isnan(housing[i]) || time[i] < options.from_s || time[i] > options.to_s) continue;
    if (first && time[i] - time[*last] > longest_bridge_s) close();
    if (!first) first = i;
    last = i;
  }
  close();
}

std::size_t different_temperatures(const hemi::calibration::SettledPoints& points) {
  std::set<long> different;
  for (const double t : points.temperature_degc) different.insert(std::lround(t));
  return different.size();
}

/// Settled points first, as they are the stronger ground; whole recordings where there are too few.
Eigen::Index choose_order(const ThermalStudy& study, Calibration& calibration) {
  const auto& options = calibration.options;
  if (options.order) return *options.order;
  if (study.settled && different_temperatures(study.settled->points()) >= 5) {
    const auto orders = hemi::calibration::study_order(study.settled->points(), options.reference_degc);
    calibration.text += orders.verdict;
    calibration.json["frequency"]["verdict"] = orders.verdict;
    return orders.chosen;
  }
  const auto order = hemi::calibration::order_of_recordings(study.stretches, options.reference_degc, 4);
  calibration.text += fmt::format(
      "Fewer than five settled temperatures: the order of f(T) comes from whole recordings: {}.\n", order);
  return order;
}

/// Residual of the whole fit over what noise explains: the frequency's own, and the thermometer's behind the
/// filter.
double excess(const ThermalStudy& study) {
  const auto& fit = *study.fit;
  const auto& first = study.stretches.front();
  double squares = 0.0, pairs = 0.0;
  for (Eigen::Index i = 2; i < first.frequency_hz.size(); ++i) {
    // Second differences: six times the variance of white noise, and nothing of a slope.
    const double difference =
        first.frequency_hz[i] - 2.0 * first.frequency_hz[i - 1] + first.frequency_hz[i - 2];
    if (std::isnan(difference)) continue;
    squares += difference * difference / 6.0;
    pairs += 1.0;
  }
  const double step_s = hemi::calibration::sample_step_s(study.stretches);
  const double own_hz = std::sqrt(squares / std::max(pairs, 1.0) / static_cast<double>(fit.averaged));
  const double middle_degc = 0.5 * (fit.polynomial.min_degc() + fit.polynomial.max_degc());
  const double case_hz = std::abs(fit.polynomial.slope_hz_per_degc(middle_degc)) *
                         hemi::calibration::reading_noise(first.case_degc) *
                         std::sqrt(step_s / (2.0 * fit.time_constant_s));
  return fit.residual_rms_hz / std::hypot(own_hz, case_hz);
}

/// The fit of whole recordings and the settled values, each with the other's result as its start.
void fit_both(ThermalStudy& study, const hemi::calibration::ThermalOptions& options) {
  study.fit = hemi::calibration::fit_thermal(study.stretches, options);
  if (study.holds.used.empty()) return;
  study.settled = hemi::calibration::fit_settled(study.stretches, study.holds.used, study.fit->polynomial,
                                                 study.fit->time_constant_s, study.fit->lag_s);
}

void take_frequency(const ThermalStudy& study, Calibration& calibration) {
  auto& model = calibration.model;
  const auto& p = study.fit->polynomial;
  const auto& c = p.coefficients_hz();
  if (!p.monotone()) {
    throw InputError(
        {study.recordings.front().path, 0, 0, "frequency_hz"},
        fmt::format("f(T) of order {} turns round between {:.1f} and {:.1f} degC, so no frequency "
                    "names one temperature",
                    p.order(), p.min_degc(), p.max_degc()),
        "ask for a lower --order, or leave the turning point out with --from and --to");
  }
  model.frequency = recording::FrequencyModel{p.reference_degc(), {c.data(), c.data() + c.size()}};
  model.document["frequency"]["calibrated_degc"] = {p.min_degc(), p.max_degc()};
  const double middle_hz = p.frequency_hz(0.5 * (p.min_degc() + p.max_degc()));
  const auto inverse = hemi::calibration::fit_inverse(p, middle_hz);
  auto& text = calibration.text;
  text +=
      fmt::format("f(T) of order {} about {} degC, from whole recordings\n", p.order(), p.reference_degc());
  std::vector<double> errors;
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    text += fmt::format("  a{} = {:+.9g} Hz/degC^{}  (standard error {:.2g})\n", i, c[i], i,
                        study.fit->standard_errors[i]);
    errors.push_back(study.fit->standard_errors[i]);
  }
  text += fmt::format(
      "  monotonic over the calibrated {:.2f} to {:.2f} degC; inverse of order {} within {:.2g} degC\n",
      p.min_degc(), p.max_degc(), inverse.coefficients_degc.size() - 1, inverse.max_error_degc);
  auto& json = calibration.json["frequency"];
  json["order"] = p.order();
  json["reference_degc"] = p.reference_degc();
  json["coefficients_hz"] = model.frequency->coefficients_hz;
  json["standard_errors_hz"] = errors;
  json["calibrated_degc"] = {p.min_degc(), p.max_degc()};
  json["inverse_error_degc"] = inverse.max_error_degc;
}

void report_time_constant(const ThermalStudy& study, Calibration& calibration) {
  const auto& fit = *study.fit;
  auto& text = calibration.text;
  text += fmt::format("time constant {:.2f} s (standard error {:.2g})", fit.time_constant_s,
                      fit.time_constant_error_s);
  auto& json = calibration.json["thermal"];
  json = {{"time_constant_s", fit.time_constant_s},
          {"standard_error_s", fit.time_constant_error_s},
          {"lag_s", fit.lag_s},
          {"residual_rms_hz", fit.residual_rms_hz}};
  if (study.settled && study.settled->time_constant_s > 0.0) {
    text += fmt::format("; from the settled stretches alone {:.2f} s ({:.2g})",
                        study.settled->time_constant_s, study.settled->time_constant_error_s);
    json["settled_time_constant_s"] = study.settled->time_constant_s;
    json["settled_standard_error_s"] = study.settled->time_constant_error_s;
  }
  text += fmt::format(
      "\n  case against frequency {:+.2f} s ({:.2g}), a nuisance; {} rows of {} samples leave {:.3g} mHz "
      "rms\n",
      fit.lag_s, fit.lag_error_s, fit.rows, fit.averaged, 1e3 * fit.residual_rms_hz);
}

void report_left_out(const ThermalStudy& study, Calibration& calibration) {
  if (!study.settled) return;
  std::vector<hemi::calibration::Hold> holds;
  for (const auto& value : study.settled->values) holds.push_back(value.hold);
  if (different_temperatures(study.settled->points()) < 4) {
    calibration.text += "Fewer than four settled temperatures: none can be left out in turn.\n";
    return;
  }
  const Eigen::Index order = study.fit->polynomial.order();
  const auto errors = hemi::calibration::leave_one_soak_out(study.stretches, holds, order,
                                                            study.fit->polynomial.reference_degc());
  double inside = 0.0, ends = 0.0;
  calibration.text += "temperature read from the settled frequency by f(T) of all other soaks\n";
  for (const auto& error : errors) {
    calibration.text += fmt::format("  {:>9.3f} degC   error {:+.5f} degC{}\n", error.case_degc,
                                    error.error_degc, error.end ? "   (end: extrapolated)" : "");
    double& largest = error.end ? ends : inside;
    if (!(std::abs(error.error_degc) <= largest)) largest = std::abs(error.error_degc);
    calibration.json["left_out_soaks"].push_back(
        {{"case_degc", error.case_degc}, {"error_degc", error.error_degc}, {"extrapolated", error.end}});
  }
  calibration.text += fmt::format("  largest: {:.5f} degC inside, {:.5f} degC at the ends\n", inside, ends);
}

[[noreturn]] void refuse(const std::vector<Recording>& recordings, const std::string& problem) {
  throw InputError({recordings.front().path, 0, 0, "case_temp_degc"}, problem,
                   "record soaks at several temperatures (hours each), or give f(T) by settled points "
                   "(CSV settled_degc,frequency_hz) or --base");
}

}  // namespace

std::optional<ThermalStudy> calibrate_thermal(const std::vector<Recording>& recordings,
                                              Calibration& calibration) {
  ThermalStudy study;
  for (const auto& recording : recordings)
    if (has_thermal_channels(recording)) study.recordings.push_back(recording);
  auto& model = calibration.model;
  const bool known = model.frequency.has_value();
  if (study.recordings.empty()) {
    if (!known) {
      throw InputError({recordings.front().path}, "f(T) needs the channels case_temp_degc and frequency_hz",
                       "record both, or give f(T): settled points (CSV settled_degc,frequency_hz), or --base "
                       "with a model that has them");
    }
    if (!model.thermal_time_constant_s)
      calibration.leave_out("thermal", "no recording has case_temp_degc and frequency_hz");
    return std::nullopt;
  }
  for (std::size_t r = 0; r < study.recordings.size(); ++r)
    add_stretches(study.recordings[r], r, calibration.options, study);
  try {
    if (study.stretches.empty()) throw std::invalid_argument("no ten minutes on end of case_temp_degc");
    study.holds = hemi::calibration::find_holds(study.stretches);
    recording::check_interrupt();
    hemi::calibration::ThermalOptions options{3, calibration.options.reference_degc, std::nullopt};
    if (known) options.known = frequency_polynomial(model);
    fit_both(study, options);
    if (!known) {
      recording::check_interrupt();
      options.order = choose_order(study, calibration);
      if (options.order != 3) fit_both(study, options);
      // One transient alone can be followed by a wrong f(T) with a wrong time constant, but not to the noise.
      if ((!study.settled || study.settled->values.empty()) && excess(study) > 10.0)
        throw std::invalid_argument(fmt::format(
            "without settled stretches the best fit leaves {:.0f} times the noise", excess(study)));
      take_frequency(study, calibration);
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    if (!known) refuse(study.recordings, fmt::format("f(T) cannot be had: {}", error.what()));
    calibration.leave_out("thermal", error.what());
    return std::nullopt;
  }
  if (!known || !model.thermal_time_constant_s) model.thermal_time_constant_s = study.fit->time_constant_s;
  report_time_constant(study, calibration);
  report_holds(study, calibration);
  recording::check_interrupt();
  if (!known) report_left_out(study, calibration);
  return study;
}

}  // namespace hemi::cli

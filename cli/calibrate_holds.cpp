// SPDX-License-Identifier: Apache-2.0
// The settled stretches, as they are printed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/calibrate.hpp"
#include "golden/calibration/voltage_fit.hpp"

namespace hemi::cli {
namespace {

using hemi::calibration::Hold;

/// A channel at rest at the hold's temperature: its value where the line through it over the simulated
/// resonator temperature meets T_h; the applied rate is taken off the rate. Nothing where the channel is
/// absent or mostly missing.
std::optional<std::pair<double, double>> settled_channel(const ThermalStudy& study, const Hold& hold,
                                                         const char* name) {
  const auto& recording = study.recordings[study.recording_of[hold.stretch]];
  const auto* channel = recording.find(name);
  if (channel == nullptr) return std::nullopt;
  const Eigen::VectorXd temperature = study.fit->temperature_degc(study.stretches, hold.stretch);
  const Eigen::Index first = study.first_row[hold.stretch] + hold.begin;
  Eigen::VectorXd value = Eigen::VectorXd::Map(&channel->values[static_cast<std::size_t>(first)], hold.count);
  if (const auto* applied = recording.find("rate_in_dph"); applied != nullptr && channel->name == "rate_dph")
    value -= Eigen::VectorXd::Map(&applied->values[static_cast<std::size_t>(first)], hold.count);
  std::vector<hemi::calibration::RowRange> ranges;
  for (Eigen::Index i = 0; i < hold.count; ++i) {
    if (std::isnan(value[i])) continue;
    if (i == 0 || std::isnan(value[i - 1])) ranges.push_back({i, 0});
    ++ranges.back().count;
  }
  try {
    const auto fit = hemi::calibration::fit_over_temperature(temperature.segment(hold.begin, hold.count),
                                                             value, ranges, hold.case_degc, 1);
    return std::make_pair(fit.coefficients[0], fit.standard_errors[0]);
  } catch (const std::exception&) {
    return std::nullopt;  // its cell stays open
  }
}

std::string place(const ThermalStudy& study, std::size_t stretch, double from_s, double to_s) {
  std::string text = fmt::format("{:>8.0f} {:>8.0f} s", from_s, to_s);
  if (study.recordings.size() > 1) text += " " + study.recordings[study.recording_of[stretch]].path;
  return text;
}

void report_refused(const ThermalStudy& study, const std::vector<hemi::calibration::RefusedHold>& refused,
                    Calibration& calibration) {
  for (const auto& hold : refused) {
    calibration.text +=
        fmt::format("  {}  {:>8.3f} degC  not used: {}\n", place(study, hold.stretch, hold.from_s, hold.to_s),
                    hold.case_degc, hold.why);
    calibration.json["refused_stretches"].push_back(
        {{"recording", study.recordings[study.recording_of[hold.stretch]].path},
         {"time_s", {hold.from_s, hold.to_s}},
         {"case_degc", hold.case_degc},
         {"why", hold.why}});
  }
}

}  // namespace

void report_holds(const ThermalStudy& study, Calibration& calibration) {
  constexpr const char* channels[] = {"drive_v", "quadrature_v", "rate_dph"};
  if (!study.settled || study.settled->values.empty())
    calibration.text += "no settled stretch: f(T) rests on transients alone\n";
  else
    calibration.text +=
        "settled stretches (frequency at rest at the case's temperature, standard error, what the last row "
        "lacks)\n";
  for (const auto& value :
       study.settled ? study.settled->values : std::vector<hemi::calibration::SettledValue>()) {
    const Hold& hold = value.hold;
    calibration.text += fmt::format("  {}  {:>8.3f} degC  f {:.5f} Hz +- {:.3f} mHz  to go {:+.2f} mHz",
                                    place(study, hold.stretch, hold.from_s, hold.to_s), hold.case_degc,
                                    value.frequency_hz, 1e3 * value.frequency_error_hz, 1e3 * value.to_go_hz);
    recording::Json json = {{"recording", study.recordings[study.recording_of[hold.stretch]].path},
                            {"time_s", {hold.from_s, hold.to_s}},
                            {"case_degc", hold.case_degc},
                            {"case_error_degc", hold.case_error_degc},
                            {"frequency_hz", value.frequency_hz},
                            {"frequency_error_hz", value.frequency_error_hz},
                            {"to_go_hz", value.to_go_hz}};
    for (const char* name : channels) {
      const auto settled = settled_channel(study, hold, name);
      if (!settled) continue;
      calibration.text += fmt::format("  {} {:.5g} +- {:.1g}", name, settled->first, settled->second);
      json[name] = {{"value", settled->first}, {"error", settled->second}};
    }
    calibration.text += "\n";
    calibration.json["settled_stretches"].push_back(json);
  }
  report_refused(study, study.holds.refused, calibration);
  if (study.settled) report_refused(study, study.settled->refused, calibration);
}

}  // namespace hemi::cli

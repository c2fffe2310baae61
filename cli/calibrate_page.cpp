// SPDX-License-Identifier: Apache-2.0
// The report of `hemi calibrate`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/invocation.hpp"
#include "cli/pages.hpp"
#include "cli/report/residuals.hpp"
#include "cli/report/ticks.hpp"
#include "golden/calibration/drift_terms.hpp"
#include "golden/calibration/settled_points.hpp"

namespace hemi::cli {
namespace {

using recording::Json;
using report::nice_number;
using report::Plot;
using report::Section;
using report::Series;

constexpr std::size_t most_stretches = 4;  // each has two plots

std::vector<double> as_vector(const Eigen::VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

/// Recordings one after another on one axis.
std::vector<double> ascending(const Eigen::VectorXd& time_s, double interval_s) {
  std::vector<double> out = as_vector(time_s);
  double shift = 0.0;
  for (std::size_t i = 1; i < out.size(); ++i) {
    if (out[i] + shift <= out[i - 1]) shift = out[i - 1] + interval_s - out[i];
    out[i] += shift;
  }
  return out;
}

/// f(T) as a smooth curve.
Series polynomial_curve(const hemi::calibration::FrequencyPolynomial& polynomial, double low, double high) {
  constexpr int steps = 200;
  std::vector<double> t, f;
  for (int i = 0; i <= steps; ++i) {
    t.push_back(low + (high - low) * i / steps);
    f.push_back(polynomial.frequency_hz(t.back()));
  }
  return Series::line("f(T)", t, f);
}

struct Settled {
  double degc, hertz, error_hz;
};

std::vector<Plot> polynomial_plots(const hemi::calibration::FrequencyPolynomial& polynomial,
                                   std::vector<Settled> points, const std::string& what) {
  std::ranges::sort(points, {}, &Settled::degc);
  if (points.empty()) return {};
  std::vector<double> degc, hertz, left, lower, upper;
  for (const Settled& p : points) {
    degc.push_back(p.degc);
    hertz.push_back(p.hertz);
    left.push_back(1e3 * (p.hertz - polynomial.frequency_hz(p.degc)));
    lower.push_back(left.back() - 1.96e3 * p.error_hz);
    upper.push_back(left.back() + 1.96e3 * p.error_hz);
  }
  Plot curve{.title = "Frequency over temperature", .x = {"temperature", "degC"}, .y = {"frequency", "Hz"}};
  curve.series.push_back(polynomial_curve(polynomial, degc.front(), degc.back()));
  curve.series.push_back(Series::dots(what, degc, hertz));
  Plot residual{.title = "What f(T) leaves", .x = {"temperature", "degC"}, .y = {what + " − f(T)", "mHz"}};
  residual.series.push_back(Series::dots(what, degc, left));
  if (std::ranges::any_of(points, [](const Settled& p) { return p.error_hz > 0.0; })) {
    residual.series.back().lower = lower;
    residual.series.back().upper = upper;
    residual.note = "Bars: 95 % intervals.";
  }
  return {curve, residual};
}

void add_thermal(const ThermalStudy& study, std::vector<Plot>& plots) {
  const auto& fit = *study.fit;
  if (study.settled) {
    std::vector<Settled> points;
    for (const auto& value : study.settled->values)
      points.push_back({value.hold.case_degc, value.frequency_hz, value.frequency_error_hz});
    for (Plot& plot : polynomial_plots(fit.polynomial, points, "settled stretches"))
      plots.push_back(std::move(plot));
  }
  for (std::size_t s = 0; s < std::min(most_stretches, study.stretches.size()); ++s) {
    const auto& stretch = study.stretches[s];
    const std::string file =
        std::filesystem::path(study.recordings[study.recording_of[s]].path).filename().string();
    const std::string link = fmt::format("time{}", s);
    const Eigen::VectorXd resonator = fit.temperature_degc(study.stretches, s);
    const std::vector<double> time = as_vector(stretch.time_s);
    Plot temperature{
        .title = file + ": temperatures", .x = {"time", "s"}, .y = {"temperature", "degC"}, .link = link};
    temperature.series.push_back(Series::line("case, measured", time, as_vector(stretch.case_degc)));
    temperature.series.push_back(Series::line("resonator, behind the lag", time, as_vector(resonator)));
    Plot left{.title = file + ": frequency less its simulation",
              .x = {"time", "s"},
              .y = {"recorded − simulated", "mHz"},
              .link = link};
    std::vector<double> residual;
    for (Eigen::Index i = 0; i < resonator.size(); ++i)
      residual.push_back(1e3 * (stretch.frequency_hz[i] - fit.polynomial.frequency_hz(resonator[i])));
    left.series.push_back(Series::line("residual", time, residual));
    for (const auto& hold : study.holds.used)
      if (hold.stretch == s) left.shades.push_back({hold.from_s, hold.to_s, "settled", true});
    plots.push_back(std::move(temperature));
    plots.push_back(std::move(left));
  }
}

void add_drift(const DriftData& drift, const recording::BiasModel& bias, std::vector<Plot>& plots) {
  const auto& samples = drift.samples;
  Eigen::VectorXd after = samples.rate_dph;
  for (Eigen::Index i = 0; i < after.size(); ++i)
    for (std::size_t k = 0; k < hemi::calibration::kDriftTermCount; ++k)
      after[i] -=
          bias.terms_dph[k] * hemi::calibration::kDriftTerms[k].value(
                                  samples.frequency_hz[i] - bias.reference_hz, samples.slope_hz_per_s[i]);
  const std::vector<double> time = ascending(drift.time_s, drift.interval_s);
  const std::vector<double> before_rate = as_vector(samples.rate_dph), after_rate = as_vector(after);
  Plot rate{.title = "Rate before and after the drift model",
            .x = {"time", "s"},
            .y = {"rate less applied rate", "deg/h"},
            .link = "time0"};
  rate.series.push_back(Series::line("before", time, before_rate, 1.5 * drift.interval_s));
  rate.series.push_back(Series::line("after", time, after_rate, 1.5 * drift.interval_s));
  if (time.back() != drift.time_s[drift.time_s.size() - 1]) {
    rate.link = "time of all";
    rate.note = "Recordings one after another.";
  }
  Plot over{.title = "Rate over frequency",
            .x = {fmt::format("frequency − {:.6g} Hz", bias.reference_hz), "Hz"},
            .y = {"rate less applied rate", "deg/h"}};
  const std::vector<double> offset = as_vector((samples.frequency_hz.array() - bias.reference_hz).matrix());
  over.series.push_back(Series::dots("before", offset, before_rate));
  over.series.push_back(Series::dots("after", offset, after_rate));
  Plot allan{
      .title = "Allan deviation of the rate",
      .x = {"averaging time", "s", true},
      .y = {"deviation", "deg/h", true},
      .note = "Over the longest stretch without a gap; bars: 68 % intervals. The rows are those of the fit."};
  if (auto series = report::allan_series("before", time, before_rate))
    allan.series.push_back(std::move(*series));
  if (auto series = report::allan_series("after", time, after_rate))
    allan.series.push_back(std::move(*series));
  plots.push_back(std::move(rate));
  plots.push_back(std::move(over));
  if (!allan.series.empty()) plots.push_back(std::move(allan));
}

std::string cell(const Json& object, const char* key, int digits = 5) {
  return object.contains(key) && object[key].is_number() ? nice_number(object[key].get<double>(), digits)
                                                         : "–";
}

const Json& part(const Json& json, const char* key) {
  static const Json none;
  return json.contains(key) ? json[key] : none;
}

report::Table drift_table(const Json& bias) {
  report::Table table{"Drift model, f in Hz from the reference, df in Hz/s",
                      {"term", "coefficient", "standard error", "p", "needed"},
                      {},
                      {}};
  for (const Json& term : part(bias, "terms"))
    table.rows.push_back({term["term"].get<std::string>(), cell(term, "coefficient"),
                          cell(term, "standard_error", 2), cell(term, "p", 2),
                          term.value("proven", false) ? "yes" : "another term could stand in"});
  return table;
}

report::Table heldout_table(const Json& list) {
  report::Table table{"Recordings that the fit has not seen: standard deviation of averages [deg/h]",
                      {"recording", "averages [s]", "rows", "before", "after", "times"},
                      {},
                      {}};
  for (const Json& entry : list)
    for (const char* rows : {"all", "warming", "cooling", "settled"})
      if (entry.contains(rows)) {
        const double before = entry[rows]["before_dph"], after = entry[rows]["after_dph"];
        table.rows.push_back({entry["recording"].get<std::string>(), cell(entry, "average_s"), rows,
                              nice_number(before, 4), nice_number(after, 4), nice_number(before / after, 3)});
      }
  return table;
}

std::string verdict_of(const Json& json) {
  if (json.contains("held_out")) {
    const Json& last = json["held_out"].back();
    if (last.contains("all"))
      return fmt::format(
          "On a recording that the fit has not seen, compensation takes the bias stability over {} s from {} "
          "to {} deg/h.",
          cell(last, "average_s"), cell(last["all"], "before_dph", 4), cell(last["all"], "after_dph", 4));
  }
  if (json.contains("scores"))
    return fmt::format(
        "The drift model leaves {} deg/h rms on blocks of the recording that its fit has not seen.",
        cell(json["scores"]["stepwise"], "held_out_rms_dph", 4));
  const Json& frequency = part(json, "frequency");
  if (frequency.contains("max_residual_hz"))
    return fmt::format("f(T) of order {} passes the settled points within {} Hz.", cell(frequency, "order"),
                       cell(frequency, "max_residual_hz", 3));
  if (json.contains("bias")) return "The drift model is fitted; no rows were left out to score it.";
  return "The model is written; these recordings hold nothing to score it on.";
}

std::vector<report::Fact> facts_of(const Calibration& calibration) {
  const Json& json = calibration.json;
  std::vector<report::Fact> facts;
  if (!calibration.model.device.empty()) facts.push_back({"Device", calibration.model.device});
  if (json.contains("frequency")) facts.push_back({"Order of f(T)", cell(json["frequency"], "order")});
  if (const Json& thermal = part(json, "thermal"); thermal.contains("time_constant_s"))
    facts.push_back({"Time constant", fmt::format("{} ± {} s", cell(thermal, "time_constant_s"),
                                                  cell(thermal, "standard_error_s", 2))});
  if (const Json& scale = part(json, "scale_factor"); scale.contains("value"))
    facts.push_back({"Scale factor", fmt::format("{:.8f} ± {}", scale["value"].get<double>(),
                                                 cell(scale, "standard_error", 2))});
  if (const Json& terms = part(part(json, "bias"), "terms"); terms.is_array())
    facts.push_back({"Terms of the drift model", fmt::format("{} of 10", terms.size())});
  if (!calibration.options.output.empty()) facts.push_back({"Written", calibration.options.output});
  return facts;
}

}  // namespace

std::vector<Plot> calibration_plots(const std::optional<ThermalStudy>& thermal,
                                    const std::optional<DriftData>& drift, const Calibration& calibration) {
  std::vector<Plot> plots;
  if (calibration.options.report.empty()) return plots;
  if (drift && calibration.model.bias) add_drift(*drift, *calibration.model.bias, plots);
  if (thermal && thermal->fit) add_thermal(*thermal, plots);
  return plots;
}

std::vector<Plot> settled_plots(const std::string& path, const Calibration& calibration) {
  if (calibration.options.report.empty()) return {};
  const auto points = hemi::calibration::read_settled_points(path);
  std::vector<Settled> settled;
  for (Eigen::Index i = 0; i < points.frequency_hz.size(); ++i)
    settled.push_back({points.temperature_degc[i], points.frequency_hz[i], 0.0});
  return polynomial_plots(frequency_polynomial(calibration.model), settled, "settled points");
}

std::string write_calibration_page(const Calibration& calibration) {
  const std::string path = report::report_path(calibration.options.report, "calibration");
  const Json& json = calibration.json;
  report::Report document{
      .kind = "calibration",
      .subject = std::filesystem::path(calibration.options.inputs.front()).filename().string(),
      .verdict = verdict_of(json),
      .tone =
          json.contains("held_out") || json.contains("scores") ? report::Tone::kGood : report::Tone::kNeutral,
      .facts = facts_of(calibration),
      .command = invocation()};
  Section figures{"The model", {}};
  if (json.contains("held_out")) figures.parts.emplace_back(heldout_table(json["held_out"]));
  if (part(json, "bias").contains("terms")) figures.parts.emplace_back(drift_table(json["bias"]));
  if (json.contains("left_out")) {
    report::Table left{"Parts that these recordings do not give", {"part", "why"}, {}, {}};
    for (const Json& entry : json["left_out"])
      left.rows.push_back({entry["part"].get<std::string>(), entry["why"].get<std::string>()});
    figures.parts.emplace_back(std::move(left));
  }
  if (!figures.parts.empty()) document.sections.push_back(std::move(figures));
  Section plots{"What it was fitted to", {}};
  for (const Plot& plot : calibration.plots) plots.parts.emplace_back(plot);
  if (!plots.parts.empty()) document.sections.push_back(std::move(plots));
  Section words{"In words", {}};
  words.parts.emplace_back(report::Verbatim{calibration.text});
  document.sections.push_back(std::move(words));
  report::write_report(path, document);
  return path;
}

}  // namespace hemi::cli

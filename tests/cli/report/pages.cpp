// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/report/pages.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "cli/report/residuals.hpp"

namespace hemi::report_test {
namespace {

struct ChannelShape {
  const char* name;
  const char* unit;
  double level, swing, noise;
};
constexpr std::array<ChannelShape, 6> kShapes = {{{"frequency_hz", "Hz", 4425.0, 12.0, 2e-4},
                                                  {"case_temp_degc", "degC", 20.0, 30.0, 0.01},
                                                  {"amplitude", "1", 1.0, 1e-4, 1e-5},
                                                  {"drive_v", "V", 2.0, 0.1, 2e-3},
                                                  {"quadrature_v", "V", 0.8, 0.05, 2e-3},
                                                  {"rate_dph", "deg/h", 2.0, 5.0, 6.0}}};

std::vector<double> seconds(std::size_t rows, double rate_hz) {
  std::vector<double> time(rows);
  for (std::size_t i = 0; i < rows; ++i) time[i] = static_cast<double>(i) / rate_hz;
  return time;
}

}  // namespace

Telemetry telemetry(std::size_t rows, double rate_hz) {
  Telemetry t{.time_s = seconds(rows, rate_hz), .channels = {}, .spikes = {}};
  std::mt19937_64 generator(7);
  std::normal_distribution<double> noise;
  for (std::size_t k = 0; k < kShapes.size(); ++k) {
    const auto& shape = kShapes[k];
    std::vector<double> values(rows);
    for (std::size_t i = 0; i < rows; ++i)
      values[i] = shape.level + shape.noise * noise(generator) +
                  shape.swing * std::sin(2 * std::numbers::pi * t.time_s[i] / t.time_s.back() *
                                         (1.0 + 0.3 * static_cast<double>(k)));
    const std::size_t at = rows / 7 * (k + 1) + 17 * k;
    values[at] = shape.level + 1.5 * shape.swing + 8.0 * shape.noise;
    t.spikes.push_back({k, t.time_s[at], values[at]});
    t.channels.push_back(std::move(values));
  }
  return t;
}

report::Report telemetry_report(const Telemetry& t) {
  report::Report page{
      .kind = "recording",
      .subject = "HRG-T1",
      .verdict = fmt::format("Six channels over {:.0f} s without a missing sample.", t.time_s.back()),
      .tone = report::Tone::kGood};
  page.facts = {{"Rows", fmt::format("{}", t.time_s.size())}, {"Channels", "6"}};
  report::Section section{"Channels", {}};
  for (std::size_t k = 0; k < kShapes.size(); ++k) {
    report::Plot plot{.title = kShapes[k].name,
                      .x = {"time", "s"},
                      .y = {kShapes[k].name, kShapes[k].unit},
                      .link = "time"};
    plot.series.push_back(report::Series::line(kShapes[k].name, t.time_s, t.channels[k]));
    if (k + 1 == kShapes.size())
      plot.stretch_command = "hemi report t.csv --from {from} --to {to} -o stretch.html";
    section.parts.emplace_back(std::move(plot));
  }
  page.sections.push_back(std::move(section));
  return page;
}

recording::Json diagnosis_json() {
  return recording::Json::parse(R"json({
    "format": "hemi-diagnosis/1", "recording": "chamber-14.csv", "model": "HRG-A17.model.json", "verdict": "named",
    "located": [{"channel": "rate_dph", "share_of_misfit": 0.83, "time_s": [[2400, 5200], [9000, 11800]],
                 "region": {"variable": "case_temp_degc", "range": [-20, -5], "when": "cooling"},
                 "band_hz": [1e-4, 1e-2], "stage": "thermal"}],
    "effects": [{"id": "thermal_gradient_bias", "probability": 0.97, "equation": "R += g (T1 - T2)",
                 "explanation": "the rate follows the difference of two temperatures in the shell",
                 "parameters": {"g_dph_per_degc": {"value": 1.83, "unit": "deg/h/degC", "ci95": [1.71, 1.95]},
                                "lag_s": {"value": 412.0, "unit": "s", "ci95": [377.0, 447.0]}}}],
    "alternatives": [{"id": "thermal_hysteresis", "score_gap": 4.2, "why_not_separable": "one ramp rate only",
                      "separating_experiment": "the same cycle at half the ramp rate, with a hold of two hours at each end"}],
    "improvement": {"rate_dph": {"train": {"before_rms": 2.87, "after_rms": 0.642, "floor_rms": 0.6},
                                 "heldout": {"before_rms": 3.11, "after_rms": 0.655, "floor_rms": 0.6, "gain_ci95": [2.1, 2.8]}}},
    "residual_after": {"white": true, "p_value": 0.4},
    "decoys": {"made": 54, "accepted": 0},
    "detection_limits": [
      {"id": "duffing", "smallest_detectable": {"k3": {"value": 3.1e-8, "unit": "1"}}, "present_below_limit": "cannot be excluded"},
      {"id": "oscillator_temperature", "smallest_detectable": {"ppm_per_degc": {"value": 0.02, "unit": "ppm/degC"}},
       "present_below_limit": "cannot be excluded"}],
    "corrected_model": "corrected.model.json"})json");
}

std::vector<report::ReportSeries> diagnosis_series() {
  report::ReportSeries s{.channel = "rate_dph", .unit = "deg/h", .time_s = seconds(14400, 1.0)};
  std::mt19937_64 generator(3);
  std::normal_distribution<double> noise(0.0, 0.6);
  for (const double t : s.time_s) {
    const bool moving = (t > 2400 && t < 5200) || (t > 9000 && t < 11800);
    const double effect =
        moving ? 5.0 * std::sin(std::numbers::pi * std::fmod(t - 2400, 6600.0) / 2800.0) : 0.0;
    const double white = noise(generator);
    s.before.push_back(effect + white);
    s.after.push_back(0.03 * effect + white);
    s.over.push_back(20.0 - 40.0 * std::sin(std::numbers::pi * t / 14400.0));
  }
  s.over_name = "case_temp_degc";
  s.over_unit = "degC";
  s.held_out_s = {{7200.0, 8400.0}};
  return {s};
}

recording::Json proof_json() {
  return recording::Json::parse(R"json({
    "format": "hemi-proof/1", "command": "hemi prove --cases 60 --baselines", "machine": "Linux x86_64, 2 processors",
    "date": "2026-11-22", "seconds": 812.0, "seed": 7, "recordings": 60, "all_held": false,
    "rows": [
      {"key": "null_named", "text": "a name where nothing is left out", "trials": 20, "value": 0.0, "ci95": [0.0, 0.161], "target": "<= 1 %", "held": true},
      {"key": "strong_first", "text": "right name first, effect at 10 x its limit and more", "trials": 24, "value": 0.917, "ci95": [0.742, 0.977], "target": ">= 95 %", "held": false},
      {"key": "coverage", "text": "95 % intervals that hold the truth", "trials": 31, "value": 0.935, "ci95": [0.793, 0.982], "target": "92 to 98 %", "held": true},
      {"key": "parameter_error", "text": "median error of a parameter at 10 x the limit", "trials": 24, "value": 0.021, "ci95": [0.014, 0.043], "target": "<= 5 %", "held": true},
      {"key": "poor", "text": "a run that cannot tell: ambiguous, with the truth in the set", "trials": 0}],
    "longest_diagnosis_s": 41.2, "largest_diagnosis_mib": 388.0,
    "classes": {"null": {"right": 20, "recordings": 20, "ci95": [0.839, 1.0]}, "single": {"right": 22, "recordings": 24, "ci95": [0.742, 0.977]}},
    "confusion": {"none": {"none": 20}, "duffing": {"duffing": 11, "unknown": 1}, "thermal_hysteresis": {"thermal_hysteresis": 10, "frequency_ageing": 1, "none": 1}},
    "calibration": [{"stated": 0.63, "right": 0.5, "ci95": [0.095, 0.905], "names": 2},
                    {"stated": 0.97, "right": 0.955, "ci95": [0.782, 0.992], "names": 22}],
    "failures": [{"recording": "single-013", "class": "single", "scenario": "cycle", "dprime": 11.2, "concealed": "duffing", "said": "unknown", "why": "said unknown"}],
    "rivals": {"lasso": {"rows": [{"key": "strong_first", "text": "", "trials": 24, "value": 0.625}], "confusion": {"none": {"none": 14, "duffing": 6}}}}})json");
}

report::Report mixed_report() {
  const auto t = telemetry(3000, 10.0);
  report::Report page{.kind = "test",
                      .subject = "<b>HRG</b> & \"co\"",
                      .verdict = "A verdict with <script>alert(1)</script> & 'quotes' in it.",
                      .tone = report::Tone::kAttention,
                      .command = "hemi test --odd '</script>'"};
  page.facts = {{"One", "1"}, {"Text", "</script><i>no markup</i>"}};
  report::Plot rates{
      .title = "Several curves </script>", .x = {"time", "s"}, .y = {"rate", "deg/h"}, .link = "time"};
  for (std::size_t k = 0; k < t.channels.size(); ++k) {
    std::vector<double> shifted;
    for (const double v : t.channels[k])
      shifted.push_back((v - t.channels[k].front()) / kShapes[k].swing + 2.0 * static_cast<double>(k));
    rates.series.push_back(report::Series::line(kShapes[k].name, t.time_s, shifted));
  }
  rates.shades = {{60.0, 120.0, "a stretch"}};
  report::Plot allan{
      .title = "Allan deviation", .x = {"averaging time", "s", true}, .y = {"deviation", "deg/h", true}};
  allan.series.push_back(*report::allan_series("rate_dph", t.time_s, t.channels[5]));
  allan.guides = {{"slope −1/2", 0.1, 6.0, 100.0, 6.0 / std::sqrt(1000.0)}};
  report::Plot dots{.title = "Rate over temperature", .x = {"temperature", "degC"}, .y = {"rate", "deg/h"}};
  dots.series.push_back(report::Series::dots("rate", t.channels[1], t.channels[5]));
  page.sections = {
      {"Chain",
       {report::Chain{{{"cic", "differs first here, in cic_xi at sample 1234"}},
                      "Upstream of it all agree."}}},
      {"Table",
       {report::Table{
           "Caption", {"name", "number"}, {{"a", "1.5"}, {"b", "−22.25"}, {"c", "–"}}, "A note."}}},
      {"Text", {report::Paragraph{"Plain <em>text</em>."}, report::Verbatim{"  two\n  lines <pre>"}}},
      {"Plots", {rates, allan, dots}}};
  return page;
}

}  // namespace hemi::report_test

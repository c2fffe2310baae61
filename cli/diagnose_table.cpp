// SPDX-License-Identifier: Apache-2.0
#include "cli/diagnose_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "cli/chain_run.hpp"
#include "cli/diagnose_report.hpp"
#include "cli/invocation.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/write.hpp"
#include "cli/report/diagnosis_report.hpp"
#include "golden/calibration/settled_points.hpp"

namespace hemi::cli {
namespace {

using diagnosis::Gain;
using diagnosis::TableDiagnosis;
using diagnosis::Verdict;
using recording::Json;

const char* const kBoardExperiment =
    "soak board and resonator at different temperatures (the board on a heater of 20 degC, the resonator "
    "through "
    "the same soaks), or count against an outside reference: what follows the board is the oscillator's, "
    "what "
    "follows the resonator is f(T)'s";
const char* const kChamberExperiment =
    "repeat every soak twice, from below and from above, with a second thermometer: a chamber's error does "
    "not "
    "come again with the same sign at the same soak";

// 10^log10_p as text, also where a double would underflow.
std::string power_of_ten(double log10_p) {
  const double exponent = std::floor(log10_p);
  return fmt::format("{:.1f}e{:.0f}", std::pow(10.0, log10_p - exponent), exponent);
}

Json alternatives(const TableDiagnosis& result) {
  if (result.verdict != Verdict::ambiguous) return Json::array();
  return {
      {{"id", "frequency_polynomial_order"},
       {"parameters",
        {{fmt::format("a{}", result.chosen),
          {{"value", result.top_coefficient},
           {"unit", fmt::format("Hz/degC^{}", result.chosen)},
           {"ci95",
            {result.top_coefficient - result.top_half_width95,
             result.top_coefficient + result.top_half_width95}}}}}},
       {"score_gap", 0.0},
       {"why_not_separable", "board and resonator share each soak's temperature"},
       {"separating_experiment", kBoardExperiment}},
      {{"id", "oscillator_temperature"},
       {"parameters", {{"ppm_span", {{"value", result.ppm_span}, {"unit", "ppm"}}}}},
       {"score_gap", 0.0},
       {"why_not_separable", "board and resonator share each soak's temperature"},
       {"separating_experiment", kBoardExperiment}},
      {{"id", "unknown"},
       {"form", "error of the chamber's temperature, another at each soak"},
       {"parameters",
        {{"chamber_error",
          {{"value", result.residual_degc}, {"unit", "degC"}, {"scatter", result.chamber_error_degc}}}}},
       {"score_gap", std::log(result.left_out.before_rms / result.left_out.after_rms)},
       {"why_not_separable",
        fmt::format("one reading a soak: errors of {:.3f} degC rms would do it; that errors at random fall "
                    "so close to a polynomial of order {} has p = {:.2g} (F-test)",
                    result.residual_degc, result.chosen, result.f_p)},
       {"separating_experiment", kChamberExperiment}}};
}

// What the baseline and the chosen order leave at each point, the rounding of the table as lines.
report::Plot residual_plot(const TableDiagnosis& result, const calibration::SettledPoints& points) {
  const auto values = [](const Eigen::VectorXd& v) {
    return std::vector<double>(v.data(), v.data() + v.size());
  };
  report::Plot plot{.title = "Settled frequency less f(T)",
                    .x = {"settled temperature", "degC"},
                    .y = {"measured − fitted", "Hz"}};
  for (const Eigen::Index order : {result.baseline, result.chosen}) {
    if (!plot.series.empty() && result.chosen == result.baseline) break;
    plot.series.push_back(report::Series::dots(fmt::format("order {}", order),
                                               values(points.temperature_degc),
                                               values(result.study.report(order).fit.residuals_hz)));
  }
  if (points.resolution_hz > 0.0) {
    const double half = 0.5 * points.resolution_hz;
    const double low = points.temperature_degc.minCoeff(), high = points.temperature_degc.maxCoeff();
    plot.guides = {{"rounding", low, half, high, half}, {"", low, -half, high, -half}};
  }
  return plot;
}

}  // namespace

Json to_json(const TableDiagnosis& result, const std::string& path) {
  Json json = {{"format", "hemi-diagnosis/1"},
               {"recording", path},
               {"model", fmt::format("polynomial of order {} in the settled temperature, fitted to the table",
                                     result.baseline)},
               {"verdict", std::string(diagnosis::name(result.verdict))}};
  json["located"] = Json::array();
  if (result.verdict != Verdict::consistent)
    json["located"].push_back(
        {{"channel", "frequency_hz"},
         {"share_of_misfit", 1.0 - std::pow(result.left_out.after_rms / result.left_out.before_rms, 2)},
         {"stage", "resonator, oscillator or chamber"}});
  json["effects"] = Json::array();
  json["alternatives"] = alternatives(result);
  json["improvement"]["frequency_hz"]["train"] = before_after(result.train, result.rounding_rms_hz);
  json["improvement"]["frequency_hz"]["heldout"] = before_after(result.left_out, result.rounding_rms_hz);
  json["orders"] = Json::array();
  for (const auto& order : result.orders) {
    json["orders"].push_back({{"order", order.order},
                              {"rms_hz", order.rms_hz},
                              {"largest_hz", order.max_hz},
                              {"least_possible_largest_hz", order.minimax_hz},
                              {"left_out_rms_hz", order.left_out_rms_hz},
                              {"left_out_largest_degc", order.left_out_max_degc}});
    if (result.rounding_rms_hz > 0.0) json["orders"].back()["log10_p_rounding"] = order.log10_p;
  }
  json["order_test"] = {
      {"chosen", result.chosen}, {"f_statistic", result.f_statistic}, {"p_value", result.f_p}};
  // Few points: the rounding's own test says whether anything is left.
  if (result.rounding_rms_hz > 0.0) {
    const double left = result.at(result.chosen).log10_p;
    json["residual_after"] = {{"white", left > -2.0}, {"p_value", std::pow(10.0, left)}};
    json["detection_limits"] = {
        {{"id", "frequency_polynomial_order"},
         {"smallest_detectable",
          {{fmt::format("a{}", result.baseline + 1),
            {{"value", result.smallest_top}, {"unit", fmt::format("Hz/degC^{}", result.baseline + 1)}}}}},
         {"present_below_limit", "cannot be excluded"}},
        {{"id", "oscillator_temperature"},
         {"smallest_detectable", {{"ppm_span", {{"value", result.smallest_ppm}, {"unit", "ppm"}}}}},
         {"present_below_limit", "cannot be excluded"}}};
  }
  return json;
}

std::string to_text(const TableDiagnosis& result) {
  std::string text = fmt::format("verdict: {}\n", diagnosis::name(result.verdict));
  for (const auto& order : result.orders) {
    text += fmt::format("  order {}: leaves up to {:.4f} Hz (no polynomial of this order less than {:.4f})",
                        order.order, order.max_hz, order.minimax_hz);
    if (result.rounding_rms_hz > 0.0)
      text += fmt::format(", p {} against the rounding alone", power_of_ten(order.log10_p));
    text += fmt::format("; each point left out {:.4f} Hz rms, up to {:.2f} degC\n", order.left_out_rms_hz,
                        order.left_out_max_degc);
  }
  text += fmt::format("order {} against {}: F = {:.4g}, p = {:.2g}\n", result.baseline + 1, result.baseline,
                      result.f_statistic, result.f_p);
  if (result.verdict == Verdict::ambiguous) {
    text += fmt::format(
        "order {} is not enough, order {} is; left out {:.4f} -> {:.4f} Hz rms. Three causes do the same "
        "here:\n"
        "  frequency_polynomial_order: a{} = {:.3g} +- {:.2g} Hz/degC^{}\n"
        "  oscillator_temperature: {:.3g} ppm peak to peak over the range\n"
        "  an error of the chamber: {:.3f} degC rms as read (scatter {:.3f} degC)\n"
        "to separate the first two: {}\nto separate the third: {}\n",
        result.baseline, result.chosen, result.left_out.before_rms, result.left_out.after_rms, result.chosen,
        result.top_coefficient, result.top_half_width95, result.chosen, result.ppm_span, result.residual_degc,
        result.chamber_error_degc, kBoardExperiment, kChamberExperiment);
  }
  if (result.rounding_rms_hz > 0.0)
    text += fmt::format("below a{} = {:.2g} Hz/degC^{} or {:.2g} ppm nothing would be seen\n",
                        result.baseline + 1, result.smallest_top, result.baseline + 1, result.smallest_ppm);
  return text;
}

int diagnose_table(const DiagnoseTableOptions& options) {
  namespace fs = std::filesystem;
  const std::string path = (fs::path(options.directory) / "diagnosis.json").string();
  const std::string page = (fs::path(options.directory) / "report.html").string();
  refuse_overwriting({path}, {options.points});
  TableDiagnosis result;
  calibration::SettledPoints points;
  try {
    points = calibration::read_settled_points(options.points, options.order + 1);
    result = diagnosis::diagnose_table(points, options.order);
  } catch (const std::invalid_argument& error) {
    throw recording::InputError({.path = options.points}, error.what(), "add soaks at other temperatures");
  }
  make_directory(options.directory);
  const Json json = to_json(result, options.points);
  const std::string text = recording::json_text(json, 2);
  recording::write_text(path, text + "\n");
  report::write_diagnosis_report(page, json, {},
                                 {.command = invocation(), .plots = {residual_plot(result, points)}});
  if (options.json)
    fmt::print("{}\n", text);
  else
    fmt::print("{}wrote {}, {}\n", to_text(result), path, page);
  return result.verdict == Verdict::consistent ? 0 : 1;
}

}  // namespace hemi::cli

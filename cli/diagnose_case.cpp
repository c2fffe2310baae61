// SPDX-License-Identifier: Apache-2.0
#include "cli/diagnose_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/chain_run.hpp"
#include "cli/diagnose_report.hpp"
#include "cli/invocation.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/write.hpp"
#include "cli/report/diagnosis_report.hpp"

namespace hemi::cli {
namespace {

using diagnosis::CaseMemory;
using diagnosis::FoundMemory;
using diagnosis::Gain;
using diagnosis::Memory;
using diagnosis::MemoryParameter;
using diagnosis::Verdict;
using recording::Json;
using recording::Recording;

constexpr std::size_t kMostCaseRows = 20000;
constexpr double kDphPerDegS = 3600.0;

const char* const kExperiment =
    "the same cycle at three speeds (a third, once, three times), each with a hold of three times the "
    "longest "
    "time constant at both ends: a lag's loop grows with the speed and decays in the hold, a hysteresis's "
    "loop "
    "is the same at every speed and stays in the hold, a drift in time goes on in the hold and does not "
    "return "
    "in the second cycle (by their form; not searched in simulation)";

// Times are row numbers where the sidecar says that the recording's own are not to be believed.
bool times_are_samples(const Recording& recording) {
  const Json& sidecar = recording.sidecar;
  return recording.time_from_rate ||
         (sidecar.contains("notes") && sidecar["notes"].is_string() &&
          sidecar["notes"].get<std::string>().find("not credible") != std::string::npos);
}

std::string unit_of(const MemoryParameter& parameter, bool samples) {
  return samples && parameter.unit == "s" ? "samples" : parameter.unit;
}

Json parameters_of(const std::vector<MemoryParameter>& list, bool samples, bool intervals) {
  Json json = Json::object();
  for (const auto& each : list) {
    json[each.name] = {{"value", each.value}, {"unit", unit_of(each, samples)}};
    // A time constant is chosen from a grid of factor four and has no interval of its own.
    if (intervals && each.half_width95 > 0.0)
      json[each.name]["ci95"] = {each.value - each.half_width95, each.value + each.half_width95};
  }
  return json;
}

std::string why_open(const CaseMemory& result, const FoundMemory& found) {
  if (result.both_ways < diagnosis::kBothWaysNeeded)
    return "the temperature goes one way only: lag, hysteresis and drift follow each other";
  if (result.decoys_accepted > 0)
    return fmt::format("{} of {} memories of a temperature that was never there do as well",
                       result.decoys_accepted, result.decoy_rms_dph.size());
  for (const auto& family : result.families)
    if (!family.beaten && !diagnosis::holds(family.family, found.memory))
      return fmt::format("'{}' leaves {:.4g} deg/h on blocks left out, the best {:.4g}: not told apart",
                         diagnosis::name(family.family), family.to_best.before_rms, family.to_best.after_rms);
  return "its strength is not the same over the parts of the recording: their interval holds zero";
}

Json alternatives(const CaseMemory& result, bool samples) {
  Json list = Json::array();
  for (const FoundMemory& found : result.open)
    list.push_back({{"id", std::string(effect_id(found.memory))},
                    {"equation", std::string(equation(found.memory))},
                    {"parameters", parameters_of(found.parameters, samples, true)},
                    {"probability", found.probability},
                    {"score_gap", found.score_gap},
                    {"why_not_separable", why_open(result, found)},
                    {"separating_experiment", kExperiment}});
  return list;
}

Json effects(const CaseMemory& result, bool samples) {
  Json list = Json::array();
  for (const FoundMemory& found : result.named)
    list.push_back({{"id", std::string(effect_id(found.memory))},
                    {"probability", found.probability},
                    {"equation", std::string(equation(found.memory))},
                    {"explanation", "every model without it leaves more on blocks left out"},
                    {"parameters", parameters_of(found.parameters, samples, true)}});
  return list;
}

// The blocks in which at least half of the polynomial's squares go.
Json located(const CaseMemory& result, const diagnosis::CaseRows& rows) {
  if (result.verdict == Verdict::consistent) return Json::array();
  const auto& before = result.selection.held_out[0];
  const auto& after = result.selection.chosen_held_out;
  Json times = Json::array();
  for (const auto& block : result.selection.blocks)
    if (2.0 * after.segment(block.begin, block.count).squaredNorm() <
        before.segment(block.begin, block.count).squaredNorm())
      times.push_back({rows.time_s[block.begin], rows.time_s[block.begin + block.count - 1]});
  const double share = 1.0 - std::pow(result.held_out.after_rms / result.held_out.before_rms, 2);
  return {{{"channel", "rate_dph"},
           {"share_of_misfit", share},
           {"time_s", times},
           {"region",
            {{"variable", "case_temp_degc"},
             {"range", {rows.case_degc.minCoeff(), rows.case_degc.maxCoeff()}},
             {"when", "same temperature, another past"}}},
           {"stage", "sensor"}}};
}

// Residuals of rows left out of the fit: the polynomial's, and those of the forms chosen without them.
report::ReportSeries series_of(const CaseMemory& result, const diagnosis::CaseRows& rows) {
  const auto values = [](const Eigen::VectorXd& v) {
    return std::vector<double>(v.data(), v.data() + v.size());
  };
  return {.channel = "rate_dph",
          .unit = "deg/h",
          .time_s = values(rows.time_s),
          .before = values(result.selection.held_out[0]),
          .after = values(result.selection.chosen_held_out),
          .over_name = "case_temp_degc",
          .over_unit = "degC",
          .over = values(rows.case_degc)};
}

}  // namespace

bool holds_case_and_rate(const Recording& recording) {
  return recording.find("rate_dph") != nullptr && recording.find("case_temp_degc") != nullptr &&
         recording.find("frequency_hz") == nullptr && recording.find("force_v") == nullptr;
}

diagnosis::CaseRows case_rows(const Recording& recording) {
  const auto& time = recording.require("time_s", "the diagnosis");
  const auto& degc = recording.require("case_temp_degc", "the diagnosis");
  const auto& rate = recording.require("rate_dph", "the diagnosis");
  const auto applied = recording.or_zero("rate_in_dph");
  std::vector<std::size_t> whole;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (!std::isnan(degc[i]) && !std::isnan(rate[i]) && !std::isnan(applied[i])) whole.push_back(i);
  const std::size_t group = whole.size() / kMostCaseRows + 1;
  const auto n = static_cast<Eigen::Index>(whole.size() / group);
  diagnosis::CaseRows rows{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < group; ++k) {
      const std::size_t row = whole[static_cast<std::size_t>(i) * group + k];
      rows.time_s[i] += time[row] / static_cast<double>(group);
      rows.case_degc[i] += degc[row] / static_cast<double>(group);
      rows.rate_dph[i] += (rate[row] - applied[row]) / static_cast<double>(group);
    }
  }
  return rows;
}

Json to_json(const CaseMemory& result, const Recording& recording) {
  const bool samples = times_are_samples(recording);
  Json json = {{"format", "hemi-diagnosis/1"},
               {"recording", recording.path},
               {"model", "polynomial in the case's temperature, fitted to the recording"},
               {"verdict", std::string(diagnosis::name(result.verdict))},
               {"time_unit", samples ? "samples" : "s"}};
  json["located"] = located(result, case_rows(recording));
  json["effects"] = effects(result, samples);
  json["alternatives"] = alternatives(result, samples);
  json["improvement"]["rate_dph"]["train"] = before_after(result.train, result.floor_rms_dph);
  json["improvement"]["rate_dph"]["heldout"] = before_after(result.held_out, result.floor_rms_dph);
  json["held_out"] = {{"blocks", diagnosis::kMemoryFolds},
                      {"note",
                       "one recording: contiguous blocks of it, the temperature's past carried through "
                       "them; weaker than another recording"}};
  for (std::size_t fold = 0; fold < result.selection.folds.size(); ++fold)
    json["held_out"]["chosen_by_fold"].push_back(
        std::string(diagnosis::name(result.selection.folds[fold].chosen)));
  json["families"] = Json::array();
  for (const auto& family : result.families)
    json["families"].push_back(
        {{"name", std::string(diagnosis::name(family.family))},
         {"train_rms",
          std::sqrt(result.selection.train[static_cast<std::size_t>(family.family)].squaredNorm() /
                    static_cast<double>(result.selection.chosen_held_out.size()))},
         {"heldout_rms", family.to_best.before_rms},
         {"to_best_ci95", {family.to_best.low, family.to_best.high}},
         {"beaten", family.beaten}});
  json["residual_after"] = {{"white", result.white_p > 0.01}, {"p_value", result.white_p}};
  json["decoys"] = {{"made", result.decoy_rms_dph.size()},
                    {"accepted", result.decoys_accepted},
                    {"heldout_rms", result.decoy_rms_dph}};
  json["detection_limits"] = Json::array();
  for (const auto& limit : result.limits)
    json["detection_limits"].push_back(
        {{"id", std::string(effect_id(limit.memory))},
         {"smallest_detectable", parameters_of(limit.smallest, samples, false)},
         {"present_below_limit", "cannot be excluded"}});
  return json;
}

std::string to_text(const CaseMemory& result, const Recording& recording) {
  const bool samples = times_are_samples(recording);
  const auto degs = [](double dph) { return dph / kDphPerDegS; };
  std::string text = fmt::format("verdict: {}\n", diagnosis::name(result.verdict));
  text += fmt::format(
      "polynomial in the case's temperature {:.4f} -> {:.4f} deg/s rms on 8 blocks left out (gain {:.4f} to "
      "{:.4f}, 95 %), {:.4f} -> {:.4f} in sample; a row's noise {:.4f}\n",
      degs(result.held_out.before_rms), degs(result.held_out.after_rms), degs(result.held_out.low),
      degs(result.held_out.high), degs(result.train.before_rms), degs(result.train.after_rms),
      degs(result.floor_rms_dph));
  for (const auto& family : result.families)
    text += fmt::format("  {:<22} {:.4f} deg/s left out{}\n", diagnosis::name(family.family),
                        degs(family.to_best.before_rms),
                        family.beaten                  ? ", beaten"
                        : family.family == result.best ? ", best"
                                                       : ", not told from the best");
  const auto tell = [&](const char* what, const FoundMemory& found) {
    text += fmt::format("{}: {} ({})", what, effect_id(found.memory), equation(found.memory));
    for (const auto& each : found.parameters)
      text +=
          each.half_width95 > 0.0
              ? fmt::format("; {} {:.4g} +- {:.2g} {}", each.name, each.value, each.half_width95, each.unit)
              : fmt::format("; {} {:.4g} {}", each.name, each.value, unit_of(each, samples));
    text += fmt::format("; probability {:.3f}\n", found.probability);
  };
  for (const auto& found : result.named) tell("named", found);
  for (const auto& found : result.open) {
    tell("possible", found);
    text += fmt::format("  {}\n", why_open(result, found));
  }
  if (!result.open.empty()) text += fmt::format("to separate them: {}\n", kExperiment);
  if (samples) text += "times are in samples: the recording's own are not to be believed\n";
  text += fmt::format("decoys not beaten: {} of {}\n", result.decoys_accepted, result.decoy_rms_dph.size());
  if (result.verdict != Verdict::consistent && result.white_p <= 0.01)
    text += "the residual is not white: what is left has a structure that no family here has\n";
  for (const auto& limit : result.limits) {
    text += fmt::format("{} {}: below {:.3g} {} it would not be seen", effect_id(limit.memory),
                        limit.smallest[0].name, limit.smallest[0].value, limit.smallest[0].unit);
    if (limit.smallest.size() > 1)
      text += fmt::format(" ({} {:.4g} {})", limit.smallest[1].name, limit.smallest[1].value,
                          unit_of(limit.smallest[1], samples));
    text += "\n";
  }
  return text;
}

int diagnose_case(const Recording& recording, const DiagnoseCaseOptions& options) {
  namespace fs = std::filesystem;
  const std::string path = (fs::path(options.directory) / "diagnosis.json").string();
  const std::string page = (fs::path(options.directory) / "report.html").string();
  refuse_overwriting({path}, {recording.path});
  print_notes(recording.notes);
  CaseMemory result;
  const diagnosis::CaseRows rows = case_rows(recording);
  try {
    result = diagnosis::diagnose_case(rows, recording::check_interrupt);
  } catch (const std::invalid_argument& error) {
    throw recording::InputError({.path = recording.path}, error.what(),
                                "record a temperature cycle of at least 256 rows");
  }
  make_directory(options.directory);
  const Json json = to_json(result, recording);
  const std::string text = recording::json_text(json, 2);
  recording::write_text(path, text + "\n");
  report::write_diagnosis_report(
      page, json, {series_of(result, rows)},
      {.command = invocation(), .time_unit = times_are_samples(recording) ? "samples" : "s"});
  if (options.json)
    fmt::print("{}\n", text);
  else
    fmt::print("{}wrote {}, {}\n", to_text(result, recording), path, page);
  return result.verdict == Verdict::consistent ? 0 : 1;
}

}  // namespace hemi::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/diagnose_telemetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/diagnose_core.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/progress.hpp"
#include "cli/recording/write.hpp"
#include "cli/report/diagnosis_report.hpp"
#include "cli/separating_scenario.hpp"
#include "cli/untestable.hpp"
#include "golden/physics/effect.hpp"

namespace hemi::cli {
namespace {

namespace fs = std::filesystem;
using diagnosis::Explanation;
using diagnosis::kOutputNames;
using diagnosis::kOutputs;
using diagnosis::Output;
using diagnosis::place;
using diagnosis::TelemetryDiagnosis;
using recording::Json;
constexpr std::size_t kMostRows = 40000;

const physics::CatalogueEntry* entry_of(const std::string& id) {
  const auto found = physics::catalogue().find(id);
  return found == physics::catalogue().end() ? nullptr : &found->second;
}

std::string explanation_of(const std::string& id) {
  const auto* entry = entry_of(id);
  return entry == nullptr ? "" : entry->description.explanation;
}

std::string experiment_for(const std::string& id) {
  const auto* entry = entry_of(id);
  return entry == nullptr || entry->description.separated_by.empty()
             ? "record the same inputs at other speeds and levels"
             : entry->description.separated_by;
}

// Block of the chain that an effect belongs to.
std::string stage_of(const std::string& id) {
  if (id.starts_with("oscillator")) return "board oscillator";
  if (id == "demodulation_phase" || id == "time_shift" || id == "pll_lag") return "core";
  if (id.starts_with("pickoff")) return "pickoff";
  if (id.starts_with("scale_factor") || id == "forcer_misalignment") return "electrodes";
  if (id == "interference" || id == "rate_flicker" || id == "rate_random_walk") return "electronics";
  return "resonator";
}

Json parameters(const Explanation& entry) {
  Json list = Json::object();
  for (const auto& each : entry.figures)
    list[each.figure.name] = {
        {"value", each.figure.value}, {"unit", each.figure.unit}, {"ci95", {each.low, each.high}}};
  return list;
}

std::string explanation(const Explanation& entry) {
  std::string text = explanation_of(entry.effect);
  for (const auto& each : entry.figures)
    if (each.held_by_start > 0.0)
      text += fmt::format(" Up to {:.2g} {} more would look like a start at another temperature.",
                          each.held_by_start, each.figure.unit);
  return text;
}

Json effect(const Explanation& entry) {
  return {{"id", entry.effect},
          {"probability", entry.probability},
          {"equation", entry.form},
          {"explanation", explanation(entry)},
          {"parameters", parameters(entry)},
          {"score_lost_without", entry.worth}};
}

Json alternative(const std::string& id, double gap, const std::string& why) {
  return {{"id", id},
          {"score_gap", gap},
          {"why_not_separable", why},
          {"separating_experiment", experiment_for(id)}};
}

Json alternatives(const TelemetryDiagnosis& result) {
  Json list = Json::array();
  std::vector<std::string> seen;
  const auto add = [&](const std::string& id, double gap, const std::string& why, const Explanation* full) {
    if (std::ranges::find(seen, id) != seen.end()) return;
    seen.push_back(id);
    list.push_back(alternative(id, gap, why));
    if (full != nullptr) {
      list.back()["probability"] = full->probability;
      list.back()["equation"] = full->form;
      list.back()["parameters"] = parameters(*full);
    }
  };
  for (const auto& entry : result.ambiguous) {
    add(entry.effect, 0.0, entry.doubt, &entry);
    for (const auto& [id, gap] : entry.near)
      add(id, gap,
          fmt::format("explains the recording as well as {} (score {:.1f} behind)", entry.effect, gap),
          nullptr);
  }
  return list;
}

Json located(const TelemetryDiagnosis& result, double start_s) {
  Json list = Json::array();
  for (const auto& each : diagnosis::locate(result)) {
    Json times = Json::array();
    for (const auto& [from, to] : each.time_s) times.push_back({start_s + from, start_s + to});
    std::string stage = "unknown";
    for (const auto* group : {&result.ambiguous, &result.named})
      for (const auto& entry : *group)
        if (entry.trace[each.output].size() > 0) stage = stage_of(entry.effect);
    list.push_back(
        {{"channel", std::string(kOutputNames[place(each.output)])},
         {"share_of_misfit", each.share},
         {"time_s", times},
         {"region", {{"variable", each.variable}, {"range", {each.low, each.high}}, {"when", each.when}}},
         {"band_hz", {each.low_hz, each.high_hz}},
         {"stage", stage}});
  }
  return list;
}

Json gain(const diagnosis::Gain& each, double floor_rms) {
  return {{"before_rms", each.before_rms},
          {"after_rms", each.after_rms},
          {"floor_rms", floor_rms},
          {"gain_ci95", {each.low, each.high}}};
}

Json limits(const TelemetryDiagnosis& result) {
  Json list = Json::array();
  for (const auto& limit : result.isolability.limits) {
    Json smallest = Json::object();
    for (const auto& figure : limit.smallest)
      smallest[figure.name] = {{"value", figure.value}, {"unit", figure.unit}};
    list.push_back({{"id", limit.effect},
                    {"equation", limit.form},
                    {"smallest_detectable", smallest},
                    {"present_below_limit", "cannot be excluded"}});
  }
  return list;
}

Json not_testable(const TelemetryDiagnosis& result, const DiagnosisInput& input) {
  std::vector<std::string> tested;
  for (const auto& family : result.hypotheses->families()) tested.push_back(family.effect);
  Json list = Json::array();
  for (const auto& each : untestable(input, tested)) list.push_back({{"id", each.id}, {"why", each.why}});
  return list;
}

// A free function of an input, in units, that has no physical name.
Json unknown_effect(const diagnosis::Remainder& remainder) {
  const auto list = [](const Eigen::VectorXd& v) { return std::vector<double>(v.begin(), v.end()); };
  const auto channel = kOutputNames[place(remainder.output)];
  if (remainder.variable.empty())
    return {{"id", "unknown"},
            {"probability", 1.0},
            {"equation", fmt::format("{} moves beyond its noise, along no input", channel)},
            {"explanation",
             fmt::format("neither an effect of the catalogue nor a function of one input or of its "
                         "past explains what {} does",
                         channel)},
            {"parameters", Json::object()},
            {"score_lost_without", remainder.evidence}};
  return {{"id", "unknown"},
          {"probability", 1.0},
          {"equation", fmt::format("{} += g({}), linear between nodes", channel, remainder.variable)},
          {"explanation", fmt::format("no effect of the catalogue explains what {} does with {}", channel,
                                      remainder.variable)},
          {"parameters", Json::object()},
          {"correction",
           {{"channel", std::string(kOutputNames[place(remainder.output)])},
            {"unit", std::string(diagnosis::kOutputUnits[place(remainder.output)])},
            {"variable", remainder.variable},
            {"at", list(remainder.at)},
            {"value", list(remainder.value)},
            {"half_width95", list(remainder.half_width)}}},
          {"score_lost_without", remainder.evidence}};
}

std::vector<report::ReportSeries> series_of(const TelemetryDiagnosis& result, double start_s) {
  std::vector<report::ReportSeries> list;
  const auto& space = result.hypotheses->space();
  const auto& s = result.hypotheses->simulation();
  const double block_s = s.telemetry->step_s * static_cast<double>(space.block_rows());
  for (const Output output : kOutputs) {
    const std::size_t c = place(output);
    if (space.rows(output) == 0) continue;
    report::ReportSeries series{.channel = std::string(kOutputNames[c]),
                                .unit = std::string(diagnosis::kOutputUnits[c])};
    for (const auto block : space.blocks(output)) {
      series.time_s.push_back(start_s + (static_cast<double>(block) + 0.5) * block_s);
      const auto row =
          std::min(block * space.block_rows() + space.block_rows() / 2, s.smooth_degc.size() - 1);
      series.over.push_back(s.smooth_degc[row]);
    }
    series.over_name = "resonator temperature";
    series.over_unit = "degC";
    const auto& before = result.baseline.residual[c];
    const auto& after = result.final.residual[c];
    series.before.assign(before.data(), before.data() + before.rows());
    series.after.assign(after.data(), after.data() + after.rows());
    list.push_back(std::move(series));
  }
  return list;
}

}  // namespace

bool holds_telemetry(const recording::Recording& recording) {
  return recording.find("force_v") == nullptr &&
         std::ranges::any_of(kOutputNames, [&](std::string_view name) {
           return name != "rate_dph" && recording.find(name) != nullptr;
         });
}

Json to_json(const TelemetryDiagnosis& result, const DiagnosisInput& input,
             const recording::Recording& recording, const std::string& model) {
  const double start_s = recording.find("time_s")->values[0];
  Json json = {{"format", "hemi-diagnosis/1"},
               {"recording", recording.path},
               {"model", model},
               {"verdict", std::string(name(result.verdict))}};
  json["located"] =
      result.verdict == diagnosis::Verdict::consistent ? Json::array() : located(result, start_s);
  json["effects"] = Json::array();
  for (const auto& entry : result.named) json["effects"].push_back(effect(entry));
  if (result.verdict == diagnosis::Verdict::unknown)
    for (const auto& remainder : result.remainders) json["effects"].push_back(unknown_effect(remainder));
  json["alternatives"] = alternatives(result);
  json["parameters"] = Json::object();
  for (const auto& each : result.parameters)
    json["parameters"][each.name] = {
        {"given", each.given},
        {"value", each.refitted},
        {"ci95", {each.refitted - 1.96 * each.deviation, each.refitted + 1.96 * each.deviation}}};
  json["recalibration_p_value"] = result.recalibration_p;
  json["improvement"] = Json::object();
  for (const auto& each : result.improvement)
    json["improvement"][std::string(kOutputNames[place(each.output)])] = {
        {"train", gain(each.train, each.floor_rms)}, {"heldout", gain(each.held_out, each.floor_rms)}};
  const auto& space = result.hypotheses->space();
  json["rows"] = {{"averaged_over_s", input.telemetry.step_s * static_cast<double>(space.block_rows())},
                  {"count", space.rows()}};
  json["residual_after"] = {{"white", result.remainders.empty()}};
  for (const auto& remainder : result.remainders)
    json["residual_after"]["still_follows"].push_back(
        {{"channel", std::string(kOutputNames[place(remainder.output)])},
         {"variable", remainder.variable},
         {"share_of_misfit", remainder.share}});
  json["decoys"] = {{"made", result.decoys.made}, {"accepted", result.decoys.accepted}};
  json["detection_limits"] = limits(result);
  json["inseparable"] = Json::array();
  for (const auto& pair : result.isolability.pairs)
    json["inseparable"].push_back({{"effects", {pair.one, pair.other}}, {"overlap", pair.overlap}});
  json["absent_channels"] = input.absent;
  json["not_testable"] = not_testable(result, input);
  json["corrected_model"] = "corrected.model.json";
  return json;
}

std::string to_text(const Json& json) {
  std::string text = fmt::format("verdict: {}\n", json["verdict"].get<std::string>());
  for (const auto& entry : json["effects"]) {
    text +=
        fmt::format("  {:<30} {}\n", entry["id"].get<std::string>(), entry["equation"].get<std::string>());
    for (const auto& [name, value] : entry["parameters"].items())
      text += fmt::format("    {:<28} {:.5g} ({:.5g} to {:.5g}) {}\n", name, value["value"].get<double>(),
                          value["ci95"][0].get<double>(), value["ci95"][1].get<double>(),
                          value["unit"].get<std::string>());
  }
  if (!json["alternatives"].empty()) text += "not named, but not excluded:\n";
  for (const auto& entry : json["alternatives"])
    text += fmt::format("  {:<30} {}\n    experiment: {}\n", entry["id"].get<std::string>(),
                        entry["why_not_separable"].get<std::string>(),
                        entry["separating_experiment"].get<std::string>());
  if (json.contains("separating_experiment"))
    text += fmt::format("what would separate them: {}\n",
                        json["separating_experiment"]["in_words"].get<std::string>());
  for (const auto& [channel, value] : json["improvement"].items())
    text += fmt::format(
        "{:<14} blocks left out: {:.4g} -> {:.4g} rms (noise {:.4g}), gain {:.3g} to {:.3g} (95 %)\n",
        channel, value["heldout"]["before_rms"].get<double>(), value["heldout"]["after_rms"].get<double>(),
        value["heldout"]["floor_rms"].get<double>(), value["heldout"]["gain_ci95"][0].get<double>(),
        value["heldout"]["gain_ci95"][1].get<double>());
  for (const auto& entry : json["located"])
    text += fmt::format(
        "{:<14} {:.0f} % of the misfit, {} stretches, {:.3g} to {:.3g} Hz, {:.1f} to {:.1f} degC, {}\n",
        entry["channel"].get<std::string>(), 100.0 * entry["share_of_misfit"].get<double>(),
        entry["time_s"].size(), entry["band_hz"][0].get<double>(), entry["band_hz"][1].get<double>(),
        entry["region"]["range"][0].get<double>(), entry["region"]["range"][1].get<double>(),
        entry["region"]["when"].get<std::string>());
  text += fmt::format("parameters moved: p {:.2g}; decoys accepted: {} of {}\n",
                      json["recalibration_p_value"].get<double>(), json["decoys"]["accepted"].get<int>(),
                      json["decoys"]["made"].get<int>());
  return text + untestable_text(json["not_testable"]);
}

recording::InstrumentModel corrected_model(const TelemetryDiagnosis& result,
                                           const recording::InstrumentModel& given) {
  recording::InstrumentModel model = given;
  const auto& now = result.corrected;
  if (model.frequency) model.frequency->coefficients_hz = now.frequency_hz.coefficients;
  // Zero: read without a case thermometer.
  if (model.thermal_time_constant_s && now.time_constant_s > 0.0)
    model.thermal_time_constant_s = now.time_constant_s;
  if (model.bias) model.bias->terms_dph = now.bias_dph;
  model.scale_factor = now.scale_factor;
  if (model.drive) model.drive->coefficients_v = now.drive_v.coefficients;
  if (model.quadrature) model.quadrature->coefficients_v = now.quadrature_v.coefficients;
  if (!model.effects.is_array()) model.effects = Json::array();
  for (const auto& entry : result.named) {
    Json effect = {{"id", entry.effect}, {"equation", entry.form}, {"parameters", parameters(entry)}};
    if (!entry.coefficients.empty())
      effect["fit"] = {{"shape", entry.shape}, {"coefficients", entry.coefficients}};
    model.effects.push_back(std::move(effect));
  }
  return model;
}

int diagnose_telemetry(const recording::Recording& recording, const DiagnoseTelemetryOptions& options) {
  if (options.model.empty())
    throw recording::InputError({.path = recording.path},
                                "telemetry is diagnosed against an instrument model",
                                "give --model NAME.model.json; hemi calibrate writes one");
  const auto model = recording::read_model(options.model);
  const auto nominal = nominal_of(model, recording);
  const DiagnosisInput input = telemetry_of(recording, model, kMostRows);
  for (const auto& notes : {recording.notes, input.notes}) print_notes(notes);
  diagnosis::TelemetryOptions search;
  make_directory(options.directory);
  TelemetryDiagnosis result;
  try {
    recording::Progress progress("diagnosis", 1.0);
    search.check = recording::check_interrupt;
    search.tick = [&](double share) { progress.update(share); };
    result = diagnosis::diagnose_telemetry(input.telemetry, nominal, search);
  } catch (const diagnosis::BadEffect& error) {
    throw recording::InputError({.path = options.model, .channel = "effects"}, error.what(),
                                "take the list as hemi diagnose wrote it");
  } catch (const std::invalid_argument& error) {
    throw recording::InputError({.path = recording.path}, error.what(), "record longer");
  }
  Json json = to_json(result, input, recording, options.model);
  const auto corrected = corrected_model(result, model);
  recording::check_interrupt();
  json["core"] = write_core(result, nominal, model, corrected, options.directory);
  const auto in = [&](const char* file) { return (fs::path(options.directory) / file).string(); };
  recording::write_model(in("corrected.model.json"), corrected);
  add_separating_experiment(json, result, nominal, model, options.directory,
                            {.tick = [](double) { recording::check_interrupt(); }});
  recording::write_text(in("diagnosis.json"), recording::json_text(json, 2) + "\n");
  report::write_diagnosis_report(
      in("report.html"), json, series_of(result, recording.find("time_s")->values[0]),
      {.command = fmt::format("hemi diagnose {} --model {}", recording.path, options.model)});
  if (options.json)
    fmt::print("{}\n", recording::json_text(json, 2));
  else
    fmt::print("{}{}wrote {}, {}, {}\n", to_text(json), core_text(json["core"]), in("diagnosis.json"),
               in("corrected.model.json"), in("report.html"));
  return result.verdict == diagnosis::Verdict::consistent ? exit_good : exit_difference;
}

}  // namespace hemi::cli

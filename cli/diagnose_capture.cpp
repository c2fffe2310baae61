// SPDX-License-Identifier: Apache-2.0
#include "cli/diagnose_capture.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <span>
#include <stdexcept>

#include "cli/capture_input.hpp"
#include "cli/capture_replay.hpp"
#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/invocation.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/json.hpp"
#include "cli/recording/write.hpp"
#include "cli/report/diagnosis_report.hpp"
#include "cli/report/residuals.hpp"

namespace hemi::cli {
namespace {

namespace fs = std::filesystem;
using diagnosis::Stage;
using diagnosis::StageDiagnosis;
using diagnosis::StageFinding;
using recording::Json;

const char* verdict_of(const StageDiagnosis& d) {
  if (d.findings.empty()) return "consistent";
  const StageFinding& first = d.findings.front();
  if (!first.rivals.empty()) return "ambiguous";
  return first.effect == "unknown" ? "unknown" : "named";
}

Json parameters_of(const StageFinding& finding) {
  Json parameters = Json::object();
  for (const auto& p : finding.parameters) {
    parameters[p.name] = {{"value", p.value}, {"unit", p.unit}};
    if (p.sigma > 0.0) parameters[p.name]["ci95"] = {p.value - 1.96 * p.sigma, p.value + 1.96 * p.sigma};
  }
  return parameters;
}

/// Share of each finding in the chi^2 of all; a core that computes wrong words has all of them.
double share_of(const StageFinding& finding, const StageDiagnosis& d) {
  double sum = 0.0;
  for (const auto& f : d.findings) sum += f.weight;
  return sum > 0.0 ? finding.weight / sum : 1.0;
}

const char* separating(Stage stage) {
  return stage == Stage::resonator
             ? "capture a step of the amplitude's set point: the share of the harmonic in the vibration goes "
               "with its amplitude, and so "
               "does the mean; gate the drive: what its force makes is gone at once"
             : "capture the same at half the amplitude: a converter's curve stays at its codes";
}

Json alternatives_of(const StageDiagnosis& d) {
  Json list = Json::array();
  for (const auto& finding : d.findings) {
    for (const Stage rival : finding.rivals)
      list.push_back({{"id", finding.effect},
                      {"stage", diagnosis::name(rival)},
                      {"why_not_separable", "one steady capture holds the same traces for both"},
                      {"separating_experiment", separating(rival)}});
  }
  return list;
}

Json to_json(const StageDiagnosis& d, const CaptureOptions& options, const std::vector<std::string>& notes) {
  Json json = {{"format", "hemi-diagnosis/1"},
               {"recording", options.capture},
               {"model", options.model},
               {"verdict", verdict_of(d)}};
  json["stage"] = diagnosis::name(d.stage);
  json["located"] = json["effects"] = json["detection_limits"] = json["tests"] = Json::array();
  for (const auto& finding : d.findings) {
    json["located"].push_back({{"channel", finding.channel},
                               {"share_of_misfit", share_of(finding, d)},
                               {"stage", diagnosis::name(finding.stage)}});
    json["effects"].push_back({{"id", finding.effect},
                               {"probability", 1.0 - finding.p},
                               {"equation", finding.equation},
                               {"explanation", finding.explanation},
                               {"parameters", parameters_of(finding)}});
  }
  json["alternatives"] = alternatives_of(d);
  for (const auto& test : d.tests) {
    json["tests"].push_back({{"name", test.name}, {"statistic", test.statistic}, {"p_value", test.p}});
    if (test.limit > 0.0)
      json["detection_limits"].push_back(
          {{"id", test.name},
           {"smallest_detectable", {{"size", {{"value", test.limit}, {"unit", test.unit}}}}},
           {"present_below_limit", "cannot be excluded"}});
  }
  if (d.core) {
    json["core"] = {{"words_compared", d.core->compared}, {"words_differing", d.core->differing}};
    if (d.core->first_record) json["core"]["first_record"] = *d.core->first_record;
    if (d.core->first_record) json["core"]["block"] = d.core->block;
  }
  json["settled_from_s"] = d.settled_from_s;
  json["notes"] = notes;
  return json;
}

std::string to_text(const StageDiagnosis& d) {
  std::string text = fmt::format("stage: {} ({})\n", diagnosis::name(d.stage), verdict_of(d));
  if (d.core)
    text += fmt::format("  core: {} of {} recorded words are not what it computes from the samples\n",
                        d.core->differing, d.core->compared);
  for (const auto& f : d.findings) {
    text += fmt::format("  {} at {}: {}\n", f.effect, diagnosis::name(f.stage), f.explanation);
    for (const auto& p : f.parameters)
      text += p.sigma > 0.0 ? fmt::format("    {} {:.4g} +- {:.2g} {}\n", p.name, p.value, p.sigma, p.unit)
                            : fmt::format("    {} {:.6g} {}\n", p.name, p.value, p.unit);
  }
  for (const auto& t : d.tests)
    text += fmt::format("  {:<28} p {:.2g}, seen from {:.2g} {}\n", t.name, t.p, t.limit, t.unit);
  return text;
}

// The tones and the floor that the stages are told apart by.
report::Plot spectrum(const diagnosis::StageCapture& capture) {
  report::Plot plot{.title = "Spectrum of the samples",
                    .x = {"frequency", "Hz", true},
                    .y = {"density", "LSB/√Hz", true},
                    .note = "Welch's mean of periodograms, Hann window."};
  std::vector<double> time_s(static_cast<std::size_t>(capture.x_lsb.size()));
  for (std::size_t i = 0; i < time_s.size(); ++i) time_s[i] = static_cast<double>(i) / capture.sample_rate_hz;
  for (const auto& [name, lsb] : {std::pair{"adc_x", &capture.x_lsb}, std::pair{"adc_y", &capture.y_lsb}}) {
    if (lsb->size() == 0 || lsb->cwiseAbs().maxCoeff() == 0.0) continue;
    const std::span values(lsb->data(), static_cast<std::size_t>(lsb->size()));
    if (auto series = report::spectrum_series(name, time_s, values))
      plot.series.push_back(std::move(*series));
  }
  return plot;
}

}  // namespace

bool is_capture(const std::string& path) {
  return recording::is_raw(path);
}

int diagnose_capture(const CaptureOptions& options) {
  const std::string json_path = (fs::path(options.directory) / "diagnosis.json").string();
  const std::string page_path = (fs::path(options.directory) / "report.html").string();
  std::vector<std::string> inputs = {options.capture};
  for (const auto& path : {options.model, options.telemetry})
    if (!path.empty()) inputs.push_back(path);
  refuse_overwriting({json_path}, inputs);
  const CaptureInput input = read_capture_input(options);
  const auto replay = make_replay(input.pairs, input.wide);
  StageDiagnosis d;
  try {
    d = diagnosis::diagnose_stage(input.capture, input.nominal,
                                  [&](const auto& registers, std::size_t samples, bool dacs) {
                                    recording::check_interrupt();
                                    return replay(registers, samples, dacs);
                                  });
  } catch (const std::invalid_argument& error) {
    throw recording::InputError({.path = options.capture, .channel = "adc_x"}, error.what(),
                                "capture half a second and more of the settled vibration");
  }
  std::vector<std::string> notes = input.notes;
  notes.insert(notes.end(), d.notes.begin(), d.notes.end());
  print_notes(notes);
  make_directory(options.directory);
  const Json json = to_json(d, options, notes);
  recording::write_text(json_path, recording::json_text(json, 2) + "\n");
  report::write_diagnosis_report(page_path, json, {},
                                 {.command = invocation(), .plots = {spectrum(input.capture)}});
  if (options.json)
    fmt::print("{}\n", recording::json_text(json, 2));
  else
    fmt::print("{}wrote {}, {}\n", to_text(d), json_path, page_path);
  return d.findings.empty() ? exit_good : exit_difference;
}

}  // namespace hemi::cli

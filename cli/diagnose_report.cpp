// SPDX-License-Identifier: Apache-2.0
#include "cli/diagnose_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "cli/recording/error.hpp"

namespace hemi::cli {
namespace {

using diagnosis::BenchDiagnosis;
using diagnosis::Gain;
using diagnosis::SimulationFit;
using diagnosis::TermTrial;
using recording::Json;

constexpr Eigen::Index kBlocks = 40;

struct LinearName {
  Eigen::Index place;
  const char* key;
  const char* unit;
};
constexpr std::array<LinearName, 4> kLinearNames = {{{diagnosis::kGain, "gain", "1/s^2"},
                                                     {diagnosis::kDamping, "damping_per_s", "1/s"},
                                                     {diagnosis::kStiffness, "stiffness_per_s2", "1/s^2"},
                                                     {diagnosis::kConstant, "constant_force", "V/s^2"}}};

double millivolts(double volts) {
  return 1e3 * volts;
}

std::string equation(const SimulationFit& fit) {
  std::string text = "y'' + d y' + k1 y";
  for (const auto term : fit.form.terms)
    text += fmt::format(" + {} {}", diagnosis::info(term).parameter, diagnosis::info(term).shape);
  return text + " = b u + c";
}

Json parameter(double value, const char* unit, double half) {
  return {{"value", value}, {"unit", unit}, {"ci95", {value - half, value + half}}};
}

int degree(diagnosis::Term term) {
  using diagnosis::Term;
  switch (term) {
    case Term::stiffness_cubic:
    case Term::damping_cubic:
    case Term::damping_amplitude:
    case Term::gain_cubic:
      return 3;
    case Term::stiffness_quintic:
      return 5;
    default:
      return 2;
  }
}

std::string separating(diagnosis::Term one, diagnosis::Term other) {
  if (degree(one) != degree(other))
    return fmt::format(
        "the same excitation at half and at twice its amplitude: the forces grow with powers {} and {} of it "
        "(by their form; not searched in simulation)",
        degree(one), degree(other));
  return "the same amplitude of displacement well below and well above the resonance: the forces grow with "
         "different powers of the frequency (by their form; not searched in simulation)";
}

Json alternatives(const BenchDiagnosis& result) {
  Json list = Json::array();
  for (const auto& group : result.set_aside) {
    const auto best = std::ranges::find_if(group, [](const TermTrial& t) { return t.overlap == 1.0; });
    for (const TermTrial& trial : group) {
      const auto& about = diagnosis::info(trial.term);
      const bool alone = group.size() == 1;
      const TermTrial& other =
          &trial == &*best && !alone ? (best == group.begin() ? group[1] : group[0]) : *best;
      list.push_back(
          {{"id", about.effect.empty() ? "unknown" : std::string(about.effect)},
           {"form", std::string(about.shape)},
           {"score_gap", trial.score_gap},
           {"heldout_after_rms", trial.gain.after_rms},
           {"why_not_separable", alone ? trial.reason
                                       : fmt::format("{}; traces overlap by {:.2f} over this excitation",
                                                     trial.reason, trial.overlap)},
           {"separating_experiment", alone ? std::string("none: nothing of the library competes")
                                           : separating(trial.term, other.term)}});
    }
  }
  return list;
}

Json effects(const BenchDiagnosis& result) {
  Json list = Json::array();
  for (const auto& named : result.named) {
    const auto& about = diagnosis::info(named.term);
    list.push_back({{"id", std::string(about.effect)},
                    {"probability", named.probability},
                    {"equation", equation(result.final)},
                    {"explanation",
                     fmt::format("force {} {} beside the linear resonator", about.parameter, about.shape)},
                    {"parameters",
                     {{std::string(about.parameter),
                       parameter(named.strength, std::string(about.unit).c_str(), named.half_width95)}}}});
  }
  return list;
}

Json trials(const BenchDiagnosis& result) {
  Json list = Json::array();
  for (const auto& step : result.steps) {
    Json rows = Json::array();
    for (const TermTrial& t : step.trials) {
      rows.push_back({{"form", std::string(diagnosis::info(t.term).shape)},
                      {"t", t.t},
                      {"p_family_wise", t.p},
                      {"free_run", t.simulated},
                      {"heldout_before_rms", t.gain.before_rms},
                      {"heldout_after_rms", t.gain.after_rms},
                      {"gain_ci95", {t.gain.low, t.gain.high}},
                      {"overlap_with_best", t.overlap},
                      {"score_gap", t.score_gap},
                      {"outcome", t.reason.empty() ? "taken" : t.reason}});
    }
    list.push_back({{"terms_before", step.before.size()}, {"trials", rows}});
  }
  return list;
}

std::string trial_table(const BenchDiagnosis& result) {
  std::string text;
  for (const auto& step : result.steps) {
    std::string with;
    for (const auto term : step.before) with += fmt::format(" {}", diagnosis::info(term).shape);
    text += fmt::format("tried beside the model{}:\n  {:<8} {:>9} {:>8} {:>22} {:>9}\n",
                        with.empty() ? " of the baseline" : " with" + with, "force", "max-T", "p",
                        "left out rms mV", "gap");
    for (const TermTrial& t : step.trials) {
      text += fmt::format("  {:<8} {:>9.2f} {:>8.2g} {:>9.4f} -> {:<9.4f} {:>9.2f}  {}{}\n",
                          diagnosis::info(t.term).shape, t.t, t.p, millivolts(t.gain.before_rms),
                          millivolts(t.gain.after_rms), t.score_gap, t.reason.empty() ? "taken" : t.reason,
                          t.simulated ? "" : " (linearised)");
    }
  }
  return text;
}

}  // namespace

Json before_after(const Gain& gain, double floor_rms) {
  return {{"before_rms", gain.before_rms},
          {"after_rms", gain.after_rms},
          {"floor_rms", floor_rms},
          {"gain_ci95", {gain.low, gain.high}}};
}

std::string to_text(const BenchDiagnosis& result) {
  std::string text = fmt::format("verdict: {}\nmodel: {}; input between samples: {}\n", name(result.verdict),
                                 equation(result.final), name(result.hold));
  for (const auto& each : kLinearNames)
    text += fmt::format("  {:<18} {:>14.7g} +- {:.2g} {}\n", each.key, result.final.parameters[each.place],
                        result.final.half_width95(each.place, kBlocks), each.unit);
  for (const auto& named : result.named) {
    const auto& about = diagnosis::info(named.term);
    text += fmt::format("  {:<18} {:>14.7g} +- {:.2g} {}  named: {}, probability {:.4f}\n", about.parameter,
                        named.strength, named.half_width95, about.unit, about.effect, named.probability);
  }
  if (result.recalibration)
    text += fmt::format("given model: {:.4f} mV, its parameters refitted {:.4f} mV, p {:.2g}\n",
                        millivolts(result.recalibration->before_rms),
                        millivolts(result.recalibration->after_rms), result.recalibration_p);
  const auto line = [&](const char* what, const Gain& gain) {
    text += fmt::format("{:<34} {:>9.4f} -> {:.4f} mV rms, gain {:.4f} to {:.4f} (95 %)\n", what,
                        millivolts(gain.before_rms), millivolts(gain.after_rms), millivolts(gain.low),
                        millivolts(gain.high));
  };
  line("free run, rows of the fit", result.train);
  line("free run, blocks left out", result.held_out);
  text +=
      fmt::format("all forces of the library at once      {:.4f} mV (floor)\n", millivolts(result.floor_rms));
  if (result.other_part) {
    line("free run, part that no fit saw", *result.other_part);
    for (const auto& [label, left] : result.other_part_rivals)
      text += fmt::format("  with {:<24} {:.4f} mV\n", label, millivolts(left));
  }
  text += trial_table(result);
  for (const auto& group : result.set_aside) {
    text += "something is left that is not named:";
    for (const auto& t : group) text += fmt::format(" {} ({});", diagnosis::info(t.term).shape, t.reason);
    text += "\n";
  }
  const double false_rate =
      result.decoys == 0 ? 0.0
                         : static_cast<double>(result.decoys_accepted) / static_cast<double>(result.decoys);
  text += fmt::format("decoys accepted: {} of {} (realised false discovery rate {:.3f})\n",
                      result.decoys_accepted, result.decoys, false_rate);
  text +=
      fmt::format("residual: white p {:.2g}, free of the force p {:.2g}\n", result.white_p, result.force_p);
  for (const auto& limit : result.limits) {
    const auto& about = diagnosis::info(limit.term);
    text += fmt::format("{} {}: below {:.3g} {} it would not be seen\n", about.effect, about.parameter,
                        limit.smallest, about.unit);
  }
  return text;
}

Json to_json(const BenchDiagnosis& result, const DiagnosedFiles& files) {
  Json json = {{"format", "hemi-diagnosis/1"},
               {"recording", files.recording},
               {"model", files.model.empty() ? "linear, fitted to the recording" : files.model},
               {"verdict", std::string(name(result.verdict))}};
  const double share = 1.0 - std::pow(result.held_out.after_rms / result.held_out.before_rms, 2);
  json["located"] = Json::array();
  if (!result.named.empty() || !result.set_aside.empty())
    json["located"].push_back({{"channel", "displacement_v"},
                               {"share_of_misfit", share},
                               {"time_s", {{files.from_s, files.to_s}}},
                               {"stage", "resonator"}});
  json["effects"] = effects(result);
  json["alternatives"] = alternatives(result);
  json["parameters"] = Json::object();
  for (const auto& each : kLinearNames)
    json["parameters"][each.key] = parameter(result.final.parameters[each.place], each.unit,
                                             result.final.half_width95(each.place, kBlocks));
  Json& improvement = json["improvement"]["displacement_v"];
  improvement["train"] = before_after(result.train, result.floor_rms);
  improvement["heldout"] = before_after(result.held_out, result.floor_rms);
  if (result.recalibration) {
    improvement["recalibration"] = before_after(*result.recalibration, result.floor_rms);
    improvement["recalibration"]["p_value"] = result.recalibration_p;
  }
  if (result.other_part) {
    improvement["unseen_part"] = before_after(*result.other_part, result.floor_rms);
    for (const auto& [label, left] : result.other_part_rivals)
      improvement["unseen_part"]["others_rms"][label] = left;
  }
  json["residual_after"] = {
      {"white", result.white_p > 0.01}, {"p_value", result.white_p}, {"force_p_value", result.force_p}};
  json["decoys"] = {{"made", result.decoys}, {"accepted", result.decoys_accepted}};
  json["steps"] = trials(result);
  json["detection_limits"] = Json::array();
  for (const auto& limit : result.limits) {
    const auto& about = diagnosis::info(limit.term);
    json["detection_limits"].push_back(
        {{"id", std::string(about.effect)},
         {"smallest_detectable",
          {{std::string(about.parameter), {{"value", limit.smallest}, {"unit", std::string(about.unit)}}}}},
         {"present_below_limit", "cannot be excluded"}});
  }
  json["corrected_model"] = "corrected.model.json";
  return json;
}

recording::InstrumentModel corrected_model(const BenchDiagnosis& result,
                                           const recording::InstrumentModel& given) {
  recording::InstrumentModel model = given;
  const auto& p = result.final.parameters;
  model.bench = {p[diagnosis::kGain], p[diagnosis::kDamping], p[diagnosis::kStiffness],
                 p[diagnosis::kConstant]};
  model.effects = Json::array();
  for (std::size_t i = 0; i < result.final.form.terms.size(); ++i) {
    const auto& about = diagnosis::info(result.final.form.terms[i]);
    const Eigen::Index place = diagnosis::kLinear + static_cast<Eigen::Index>(i);
    model.effects.push_back(
        {{"id", std::string(about.effect)},
         {"parameters",
          {{std::string(about.parameter), parameter(p[place], std::string(about.unit).c_str(),
                                                    result.final.half_width95(place, kBlocks))}}}});
  }
  return model;
}

diagnosis::BenchPrior prior_of(const recording::InstrumentModel& model) {
  if (!model.bench)
    throw recording::InputError({.path = model.path, .channel = "bench"}, "is missing",
                                "give the model of a bench resonator, or none");
  const auto& bench = *model.bench;
  std::vector<double> values = {bench.gain, bench.damping_per_s, bench.stiffness_per_s2,
                                bench.constant_force};
  diagnosis::BenchPrior prior;
  const Json list = model.effects.is_null() ? Json::array() : model.effects;
  for (const Json& effect : list) {
    const std::string id = recording::text_or_empty(effect, "id", model.path);
    bool found = false;
    for (const auto& about : diagnosis::bench_terms()) {
      const std::string key(about.parameter);
      if (about.effect != id || !effect.contains("parameters") || !effect["parameters"].contains(key))
        continue;
      const Json& value = effect["parameters"][key];
      if (!value.is_object()) continue;
      prior.terms.push_back(about.term);
      values.push_back(recording::number_or(value, "value", 0.0, model.path, "effects." + key));
      found = true;
    }
    if (!found)
      throw recording::InputError({.path = model.path, .channel = "effects"},
                                  "no effect of a bench resonator: " + recording::in_quotes(id),
                                  "known: duffing k3, quadratic_stiffness k2, damping_nonlinearity c2, c3");
  }
  prior.parameters = Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
  return prior;
}

}  // namespace hemi::cli

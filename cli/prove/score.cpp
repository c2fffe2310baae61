// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/score.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace hemi::prove {
namespace {

/// Named, or a candidate.
bool mentioned(const Answer& answer, const std::string& id) {
  return among(answer.names(), id) || among(answer.candidates(), id);
}

bool all_mentioned(const Truth& truth, const Answer& answer) {
  return std::all_of(truth.effects.begin(), truth.effects.end(),
                     [&](const auto& effect) { return mentioned(answer, effect.id); });
}

std::string said(const Answer& answer) {
  if (!answer.failure.empty()) return "no answer";
  const auto names = answer.names(), candidates = answer.candidates();
  if (!candidates.empty())
    return fmt::format("ambiguous: {}{}{}", fmt::join(names, " + "), names.empty() ? "" : " + ",
                       fmt::join(candidates, " / "));
  return names.empty() ? answer.verdict : fmt::format("{}", fmt::join(names, " + "));
}

/// Column of the confusion matrix: the first name, or the verdict.
std::string column(const Answer& answer) {
  if (!answer.failure.empty()) return "no answer";
  const auto names = answer.names();
  return names.empty() || answer.verdict == "ambiguous" ? answer.verdict : names.front();
}

std::string concealed(const Truth& truth) {
  std::vector<std::string> ids;
  for (const auto& effect : truth.effects) ids.push_back(effect.id);
  if (!ids.empty()) return fmt::format("{}", fmt::join(ids, " + "));
  if (!truth.changed.empty()) return fmt::format("{}", fmt::join(truth.changed, ", "));
  return truth.confounders.empty() ? "nothing" : fmt::format("{}", fmt::join(truth.confounders, "; "));
}

std::vector<std::string> wrong_names(const Truth& truth, const Answer& answer) {
  std::vector<std::string> wrong;
  for (const auto& id : answer.names())
    if (!truth.holds(id) && !among(truth.tolerated, id)) wrong.push_back(id);
  return wrong;
}

/// A name, or an ambiguous set, where there is nothing to name.
bool false_claim(const Truth& truth, const Answer& answer) {
  if (!answer.claims()) return false;
  if (answer.verdict == "ambiguous") {
    const auto set = answer.candidates();
    if (std::any_of(set.begin(), set.end(), [&](const auto& id) { return among(truth.tolerated, id); }))
      return !wrong_names(truth, answer).empty();
    return true;
  }
  return !wrong_names(truth, answer).empty();
}

/// Numbers whose sign is a matter of convention.
bool unsigned_parameter(const std::string& id, const std::string& name) {
  return name == "loop_height" || name == "span" || name == "density" || name == "amplitude" ||
         name == "delay" || (id == "electrostatic_softening" && name == "relative_shift");
}

Row rate_row(const std::string& key, const std::string& text, const Rate& rate, const std::string& target,
             bool held) {
  const auto [low, high] = wilson95(rate);
  return {key, text, rate.value(), low, high, rate.trials, target, rate.trials == 0 || held};
}

}  // namespace

bool right_first(const Truth& truth, const Answer& answer) {
  const auto names = answer.names();
  const std::string& id = truth.effects.at(0).id;
  if (answer.verdict == "named") return !names.empty() && names.front() == id;
  // Where telemetry cannot decide, the set that holds the truth is the right answer.
  return !truth.set.empty() && names.empty() && among(answer.candidates(), id);
}

bool right(const Truth& truth, const Answer& answer, std::string& why) {
  const auto fail = [&](const std::string& reason) {
    why = reason;
    return false;
  };
  if (!answer.failure.empty()) return fail(answer.failure);
  if (truth.cls == "null" || truth.cls == "params" || truth.cls == "confounder") {
    if (false_claim(truth, answer)) return fail("a name where nothing is left out");
    if (answer.verdict == "unknown") return fail("unknown physics where nothing is left out");
    return true;
  }
  const auto wrong = wrong_names(truth, answer);
  if (!wrong.empty()) return fail(fmt::format("wrong name: {}", fmt::join(wrong, ", ")));
  if (truth.cls == "weak")
    return !answer.claims() || fail(fmt::format("claimed at d' = {:.2f}", truth.dprime));
  if (truth.cls == "unknown") return answer.verdict == "unknown" || fail("not told as unknown");
  if (truth.cls == "pair") return all_mentioned(truth, answer) || fail("not both");
  if (truth.cls == "poor") {
    if (!mentioned(answer, truth.effects.back().id)) return fail("the truth is not among the candidates");
    return answer.verdict == "ambiguous" || fail("told as certain over a run that cannot tell");
  }
  return right_first(truth, answer) || fail("not named first");
}

bool resolves(const Truth& truth, const Answer& answer) {
  static const std::vector<std::string> kOfOneClock{"frequency_ageing", "oscillator_ageing"};
  if (!wrong_names(truth, answer).empty()) return false;
  const std::string& id = truth.effects.back().id;
  if (answer.verdict == "named") return among(answer.names(), id);
  const auto left = answer.candidates();
  return among(kOfOneClock, id) && among(left, id) &&
         std::all_of(left.begin(), left.end(), [&](const auto& one) { return among(kOfOneClock, one); });
}

void Score::add_experiment(const Truth& truth, const Answer& answer) {
  experiments_.add(resolves(truth, answer));
  if (!resolves(truth, answer))
    failures_.push_back({truth.name, truth.cls, "proposed", concealed(truth), said(answer),
                         "the proposed experiment does not resolve it", truth.dprime});
}

void Score::add(const Truth& truth, const Answer& answer) {
  std::string why;
  const bool good = right(truth, answer, why);
  by_class_[truth.cls].add(good);
  answered_.add(answer.failure.empty());
  if (!good)
    failures_.push_back(
        {truth.name, truth.cls, truth.scenario, concealed(truth), said(answer), why, truth.dprime});
  ++confusion_[truth.label()][column(answer)];
  longest_s_ = std::max(longest_s_, answer.seconds);
  peak_mib_ = std::max(peak_mib_, answer.peak_mib);
  add_names(truth, answer);
  if (answer.names_only) return;
  add_parameters(truth, answer);
  add_improvement(truth, answer);
  add_place(truth, answer);
}

void Score::add_names(const Truth& truth, const Answer& answer) {
  const auto wrong = wrong_names(truth, answer);
  if (truth.cls == "null") {
    null_named_.add(false_claim(truth, answer));
    null_unknown_.add(answer.verdict == "unknown");
  }
  if (truth.cls == "params") params_named_.add(false_claim(truth, answer));
  if (truth.cls == "confounder") confounder_named_.add(false_claim(truth, answer));
  if (truth.cls == "single_strong") strong_.add(right_first(truth, answer));
  if (truth.cls == "single_moderate") moderate_.add(right_first(truth, answer));
  if (truth.cls == "weak") weak_silent_.add(!answer.claims());
  if (truth.cls == "unknown") {
    unknown_.add(answer.verdict == "unknown");
    unknown_named_.add(answer.claims());
  }
  if (truth.cls == "pair") pairs_.add(all_mentioned(truth, answer) && wrong.empty());
  std::string why;
  if (truth.cls == "poor") poor_.add(right(truth, answer, why));
  for (const auto& id : answer.names()) {
    const bool is_wrong = among(wrong, id);
    wrong_names_.add(is_wrong);
    const Named* effect = answer.find(id);
    if (effect != nullptr && effect->probability) stated_.emplace_back(*effect->probability, !is_wrong);
  }
  if (answer.verdict == "ambiguous") {
    const auto set = answer.candidates();
    sets_with_truth_.add(
        std::any_of(set.begin(), set.end(), [&](const auto& id) { return truth.holds(id); }));
  }
  if (truth.cls == "single_strong" && truth.set.empty() && !answer.names_only) {
    const Named* effect = answer.find(truth.effects.at(0).id);
    on_truth_.push_back(effect != nullptr && effect->probability ? *effect->probability : 0.0);
  }
}

void Score::add_parameters(const Truth& truth, const Answer& answer) {
  for (const HiddenTruth& effect : truth.effects) {
    const Named* named = answer.find(effect.id);
    if (named == nullptr || !among(answer.names(), effect.id)) continue;
    for (const auto& [name, value] : effect.parameters) {
      const auto stated = named->parameters.find(name);
      if (stated == named->parameters.end()) continue;
      const bool size = unsigned_parameter(effect.id, name);
      Parameter given = stated->second;
      if (size && given.value < 0.0) given = {-given.value, -given.high, -given.low};
      const double truth_value = size ? std::abs(value) : value;
      covered_.add(given.low <= truth_value && truth_value <= given.high);
      if (truth.cls == "single_strong" && truth_value != 0.0)
        errors_.push_back(std::abs(given.value / truth_value - 1.0));
    }
  }
}

void Score::add_improvement(const Truth& truth, const Answer& answer) {
  if (truth.cls != "single_strong" && truth.cls != "pair") return;
  if (truth.located.empty()) return;
  const std::string& channel = truth.located.front().channel;
  const auto gain = answer.heldout.find(channel);
  const auto noise = truth.noise_rms.find(channel);
  if (noise == truth.noise_rms.end()) return;
  if (gain == answer.heldout.end()) {
    closed_.push_back(0.0);
    return;
  }
  // Figures well below the noise of one-second samples are of averages; then the floor is the answer's own.
  const Misfit& misfit = gain->second;
  const double floor = misfit.before_rms < 0.7 * noise->second ? misfit.floor_rms : noise->second;
  const double closable = std::pow(misfit.before_rms, 2) - floor * floor;
  if (closable < 0.1 * floor * floor) return;  // less than the sampling error of a variance can tell
  closed_.push_back((std::pow(misfit.before_rms, 2) - std::pow(misfit.after_rms, 2)) / closable);
}

void Score::add_place(const Truth& truth, const Answer& answer) {
  if (truth.cls != "single_strong" && truth.cls != "unknown") return;
  if (truth.located.empty()) return;
  const Located& there = truth.located.front();
  const auto here = std::find_if(answer.located.begin(), answer.located.end(),
                                 [&](const Located& place) { return place.channel == there.channel; });
  if (here == answer.located.end()) {
    overlaps_.push_back(0.0);
    return;
  }
  const auto& parameters = truth.effects.at(0).parameters;
  const auto line = parameters.find("frequency");
  if (line != parameters.end()) {  // a line lies in a band, not in time
    const bool hit = here->band_hz && here->band_hz->first <= line->second &&
                     line->second <= here->band_hz->second &&
                     here->band_hz->second < 2.0 * std::max(here->band_hz->first, 1e-6);
    overlaps_.push_back(hit ? 1.0 : 0.0);
    return;
  }
  overlaps_.push_back(overlap(here->time_s, there.time_s));
}

std::vector<Row> Score::rows() const {
  std::vector<Row> rows{rate_row("null_named", "a name where nothing is left out", null_named_, "<= 1 %",
                                 null_named_.value() <= 0.01),
                        rate_row("params_named", "a name where only numbers are wrong", params_named_,
                                 "<= 2 %", params_named_.value() <= 0.02),
                        rate_row("strong_first", "right name first, effect at 10 x its limit and more",
                                 strong_, ">= 95 %", strong_.value() >= 0.95),
                        rate_row("moderate_first", "right name first, effect at 3 to 10 x its limit",
                                 moderate_, ">= 80 %", moderate_.value() >= 0.80),
                        rate_row("wrong_names", "wrong among the names issued", wrong_names_, "<= 2 %",
                                 wrong_names_.value() <= 0.02),
                        rate_row("weak_silent", "effect below the limit: no name", weak_silent_, ">= 95 %",
                                 weak_silent_.value() >= 0.95),
                        rate_row("unknown", "effect outside the catalogue: unknown", unknown_, ">= 90 %",
                                 unknown_.value() >= 0.90),
                        rate_row("unknown_named", "effect outside the catalogue: a wrong name",
                                 unknown_named_, "<= 5 %", unknown_named_.value() <= 0.05),
                        rate_row("pairs", "pairs: both named, or in the set given as ambiguous", pairs_,
                                 ">= 85 %", pairs_.value() >= 0.85),
                        rate_row("coverage", "95 % intervals that hold the truth", covered_, "92 to 98 %",
                                 covered_.value() >= 0.92 && covered_.value() <= 0.98)};
  const auto add = [&](const char* key, const char* text, double value, std::pair<double, double> interval,
                       std::size_t trials, const char* target, bool held) {
    rows.push_back({key, text, value, interval.first, interval.second, static_cast<int>(trials), target,
                    trials == 0 || held});
  };
  const double error = median(errors_), closed = median(closed_), calibration = calibration_error(stated_);
  const Mean place = mean95(overlaps_), on_truth = mean95(on_truth_);
  add("parameter_error", "median error of a parameter at 10 x the limit", error, median_interval95(errors_),
      errors_.size(), "<= 5 %", error <= 0.05);
  add("closed", "median share of the closable misfit that is closed, held out", closed,
      median_interval95(closed_), closed_.size(), ">= 0.9", closed >= 0.9);
  add("calibration", "expected calibration error of the probabilities", calibration,
      {calibration, calibration}, stated_.size(), "<= 0.05", calibration <= 0.05);
  add("on_truth", "mean probability on the truth, at 10 x the limit", on_truth.value,
      {on_truth.low, on_truth.high}, on_truth_.size(), ">= 0.90", on_truth.value >= 0.90);
  add("overlap", "mean overlap of the place (time or band)", place.value, {place.low, place.high},
      overlaps_.size(), ">= 0.7", place.value >= 0.7);
  rows.push_back(rate_row("experiment", "the proposed experiment resolves the ambiguity", experiments_,
                          ">= 90 %", experiments_.value() >= 0.90));
  rows.push_back(rate_row("confounder_named", "a name where only the recording is disturbed",
                          confounder_named_, "", true));
  rows.push_back(
      rate_row("null_unknown", "unknown physics where nothing is left out", null_unknown_, "", true));
  rows.push_back(
      rate_row("poor", "a run that cannot tell: ambiguous, with the truth in the set", poor_, "", true));
  rows.push_back(rate_row("sets", "ambiguous sets that hold a truth", sets_with_truth_, "", true));
  rows.push_back(rate_row("answered", "recordings with an answer", answered_, ">= 100 %",
                          answered_.hits == answered_.trials));
  return rows;
}

}  // namespace hemi::prove

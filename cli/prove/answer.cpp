// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/answer.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace hemi::prove {
namespace {

using recording::Json;

constexpr const char* kUnknown = "unknown";

std::pair<double, double> interval(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>()};
}

Named named(const Json& json) {
  Named effect;
  effect.id = json.at("id").get<std::string>();
  if (json.contains("probability") && json["probability"].is_number())
    effect.probability = json["probability"].get<double>();
  if (!json.contains("parameters")) return effect;
  for (const auto& [name, parameter] : json["parameters"].items()) {
    if (!parameter.is_object() || !parameter.contains("value") || !parameter["value"].is_number()) continue;
    Parameter read;
    read.value = read.low = read.high = parameter["value"].get<double>();
    if (parameter.contains("ci95") && parameter["ci95"].is_array() && parameter["ci95"].size() == 2 &&
        parameter["ci95"][0].is_number() && parameter["ci95"][1].is_number())
      std::tie(read.low, read.high) = interval(parameter["ci95"]);
    effect.parameters[name] = read;
  }
  return effect;
}

Located located(const Json& json) {
  Located place;
  place.channel = json.value("channel", "");
  if (json.contains("time_s") && json["time_s"].is_array())
    for (const auto& stretch : json["time_s"]) place.time_s.push_back(interval(stretch));
  if (json.contains("band_hz") && json["band_hz"].is_array() && json["band_hz"].size() == 2)
    place.band_hz = interval(json["band_hz"]);
  return place;
}

Misfit misfit(const Json& json) {
  return {json.at("before_rms").get<double>(), json.at("after_rms").get<double>(),
          json.at("floor_rms").get<double>()};
}

void read_parts(const Json& document, Answer& answer) {
  if (document.contains("effects"))
    for (const auto& effect : document["effects"]) answer.effects.push_back(named(effect));
  if (document.contains("alternatives"))
    for (const auto& other : document["alternatives"])
      answer.alternatives.push_back(other.at("id").get<std::string>());
  if (document.contains("located"))
    for (const auto& place : document["located"]) answer.located.push_back(located(place));
  if (!document.contains("improvement")) return;
  for (const auto& [channel, gain] : document["improvement"].items()) {
    if (gain.is_object() && gain.contains("heldout") && gain["heldout"].is_object() &&
        gain["heldout"].contains("before_rms"))
      answer.heldout[channel] = misfit(gain["heldout"]);
  }
}

}  // namespace

bool among(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

std::vector<std::string> Answer::names() const {
  std::vector<std::string> issued;
  if (!claims()) return issued;
  for (const Named& effect : effects) {
    if (effect.id == kUnknown || (verdict == "ambiguous" && among(alternatives, effect.id))) continue;
    issued.push_back(effect.id);
  }
  return issued;
}

std::vector<std::string> Answer::candidates() const {
  return verdict == "ambiguous" ? alternatives : std::vector<std::string>{};
}

bool Answer::claims() const {
  return failure.empty() && (verdict == "named" || verdict == "ambiguous");
}

const Named* Answer::find(const std::string& id) const {
  for (const Named& effect : effects)
    if (effect.id == id) return &effect;
  return nullptr;
}

Answer parse_answer(const Json& document) {
  static constexpr std::array<const char*, 5> kVerdicts{"consistent", "recalibrate", "named", "ambiguous",
                                                        kUnknown};
  Answer answer;
  if (!document.is_object() || document.value("format", "") != "hemi-diagnosis/1")
    throw std::runtime_error("no document of format hemi-diagnosis/1");
  answer.verdict = document.value("verdict", "");
  if (std::find(kVerdicts.begin(), kVerdicts.end(), answer.verdict) == kVerdicts.end())
    throw std::runtime_error("no such verdict: '" + answer.verdict + "'");
  try {
    read_parts(document, answer);
  } catch (const Json::exception& error) {
    throw std::runtime_error(std::string("not as the format says: ") + error.what());
  }
  return answer;
}

bool Truth::holds(const std::string& id) const {
  return std::any_of(effects.begin(), effects.end(), [&](const auto& effect) { return effect.id == id; });
}

std::string Truth::label() const {
  if (cls == "single_strong" || cls == "single_moderate" || cls == kUnknown) return effects.at(0).id;
  if (cls == "poor") return "poor: " + effects.back().id;
  return cls;
}

Truth parse_truth(const Json& document) {
  Truth truth;
  truth.name = document.at("name").get<std::string>();
  truth.cls = document.at("cls").get<std::string>();
  truth.scenario = document.at("scenario").get<std::string>();
  truth.dprime = document.at("dprime").get<double>();
  for (const auto& json : document.at("effects")) {
    HiddenTruth effect;
    effect.id = json.at("id").get<std::string>();
    effect.channel = json.at("channel").get<std::string>();
    effect.dprime = json.at("dprime").get<double>();
    for (const auto& [name, value] : json.at("parameters").items())
      effect.parameters[name] = value.get<double>();
    truth.effects.push_back(std::move(effect));
  }
  truth.set = document.at("set").get<std::vector<std::string>>();
  truth.tolerated = document.at("tolerated").get<std::vector<std::string>>();
  truth.changed = document.at("changed").get<std::vector<std::string>>();
  truth.confounders = document.at("confounders").get<std::vector<std::string>>();
  std::vector<std::pair<double, Located>> places;
  for (const auto& place : document.at("located"))
    places.emplace_back(place.at("share_of_misfit").get<double>(), located(place));
  std::stable_sort(places.begin(), places.end(), [](auto& a, auto& b) { return a.first > b.first; });
  for (auto& place : places) truth.located.push_back(std::move(place.second));
  for (const auto& [channel, rms] : document.at("noise_rms").items())
    truth.noise_rms[channel] = rms.get<double>();
  return truth;
}

}  // namespace hemi::prove

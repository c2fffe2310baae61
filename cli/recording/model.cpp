// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cli/recording/error.hpp"
#include "cli/recording/write.hpp"

namespace hemi::recording {
namespace {

// An object of the document with the names that messages about it need.
struct Section {
  const Json& object;
  const std::string& path;
  std::string name;

  [[noreturn]] void refuse(const std::string& key, const std::string& problem,
                           const std::string& remedy) const {
    throw InputError({.path = path, .channel = name.empty() ? key : name + "." + key}, problem, remedy);
  }
  double number(const char* key) const {
    if (!object.contains(key)) refuse(key, "is missing", "add the number");
    return number_or(object, key, 0.0, path, name);
  }
  double number_or_default(const char* key, double fallback) const {
    return number_or(object, key, fallback, path, name);
  }
  std::vector<double> polynomial(const char* key) const {
    const Json list = object.value(key, Json());
    const bool numbers =
        list.is_array() && std::ranges::all_of(list, [](const Json& item) { return item.is_number(); });
    if (!numbers || list.empty()) {
      refuse(key, "expected a list of numbers", "give the coefficients in ascending order");
    }
    return list.get<std::vector<double>>();
  }
  std::optional<Section> section(const char* key) const {
    const auto found = object.find(key);
    if (found == object.end() || found->is_null()) return std::nullopt;
    if (!found->is_object()) refuse(key, "expected an object", "write {\"...\": ...}");
    return Section{*found, path, name.empty() ? key : name + "." + key};
  }
};

BiasModel read_bias(const Section& section) {
  BiasModel bias{.reference_hz = section.number("reference_hz")};
  const auto terms = section.section("terms_dph");
  if (!terms) section.refuse("terms_dph", "is missing", "add an object of terms");
  for (const auto& [key, value] : terms->object.items()) {
    const auto* term = std::ranges::find(kBiasTerms, key);
    if (term == kBiasTerms.end()) {
      terms->refuse(key, "no such term", fmt::format("known: {}", fmt::join(kBiasTerms, ", ")));
    }
    bias.terms_dph[static_cast<std::size_t>(term - kBiasTerms.begin())] = terms->number(key.c_str());
  }
  return bias;
}

VoltageModel read_voltage(const Section& section) {
  return {section.number("reference_degc"), section.polynomial("coefficients_v")};
}

NoiseModel read_noise(const Section& section, const std::string& key, const Json& value) {
  NoiseModel noise;
  if (value.is_object()) {
    const Section parts{value, section.path, section.name + "." + key};
    noise = {parts.number_or_default("white", 0.0), parts.number_or_default("flicker", 0.0),
             parts.number_or_default("random_walk", 0.0), parts.number_or_default("differenced", 0.0)};
  } else {
    noise.white = section.number(key.c_str());
  }
  if (std::min({noise.white, noise.flicker, noise.random_walk, noise.differenced}) < 0.0) {
    section.refuse(key, "a noise density below zero", "correct it");
  }
  return noise;
}

Json to_json(const NoiseModel& noise) {
  if (noise.flicker == 0.0 && noise.random_walk == 0.0 && noise.differenced == 0.0) return noise.white;
  return {{"white", noise.white},
          {"flicker", noise.flicker},
          {"random_walk", noise.random_walk},
          {"differenced", noise.differenced}};
}

// Sets the keys of a part and leaves the others; removes the part where it is absent.
void put(Json& document, const char* key, const std::optional<Json>& part) {
  if (!part) {
    document.erase(key);
    return;
  }
  document[key].update(*part);
}

void read_physics(const Section& top, InstrumentModel& model) {
  if (const auto section = top.section("frequency")) {
    model.frequency = {section->number("reference_degc"), section->polynomial("coefficients_hz")};
  }
  if (const auto section = top.section("thermal")) {
    model.thermal_time_constant_s = section->number("time_constant_s");
    if (*model.thermal_time_constant_s < 0.0) section->refuse("time_constant_s", "below zero", "correct it");
  }
  if (const auto section = top.section("bias")) model.bias = read_bias(*section);
  if (const auto section = top.section("drive")) model.drive = read_voltage(*section);
  if (const auto section = top.section("quadrature")) model.quadrature = read_voltage(*section);
  if (const auto section = top.section("amplitude")) {
    model.amplitude_setpoint = section->number("setpoint");
    if (!(model.amplitude_setpoint > 0.0)) section->refuse("setpoint", "not above zero", "correct it");
  }
  if (const auto section = top.section("bench")) {
    model.bench = {section->number("gain"), section->number("damping_per_s"),
                   section->number("stiffness_per_s2"), section->number_or_default("constant_force", 0.0)};
  }
}

}  // namespace

InstrumentModel model_from_json(const Json& document, const std::string& path) {
  const std::string format = text_or_empty(document, "format", path);
  if (format != kModelFormat) {
    throw InputError({.path = path, .channel = "format"},
                     format.empty() ? "is missing" : in_quotes(format) + " is no instrument model",
                     fmt::format("give a file with \"format\": \"{}\"", kModelFormat));
  }
  InstrumentModel model{.path = path, .device = text_or_empty(document, "device", path)};
  model.document = document;
  const Section top{model.document, path, ""};
  read_physics(top, model);
  model.scale_factor = top.number_or_default("scale_factor", 1.0);
  if (model.scale_factor == 0.0) top.refuse("scale_factor", "is zero", "correct it");
  if (const auto section = top.section("noise")) {
    for (const auto& [key, value] : section->object.items())
      model.noise[key] = read_noise(*section, key, value);
  }
  model.effects = document.value("effects", Json());
  if (!model.effects.is_null() && !model.effects.is_array()) {
    top.refuse("effects", "expected a list", "write [{\"id\": ...}]");
  }
  return model;
}

InstrumentModel read_model(const std::string& path) {
  return model_from_json(read_json_object(path), path);
}

Json to_json(const InstrumentModel& model) {
  Json document = model.document;
  document["format"] = kModelFormat;
  if (!model.device.empty()) document["device"] = model.device;
  const auto voltage = [](const std::optional<VoltageModel>& part) -> std::optional<Json> {
    if (!part) return std::nullopt;
    return Json{{"reference_degc", part->reference_degc}, {"coefficients_v", part->coefficients_v}};
  };
  std::optional<Json> frequency, thermal, bias, noise, bench;
  if (model.frequency) {
    frequency = Json{{"reference_degc", model.frequency->reference_degc},
                     {"coefficients_hz", model.frequency->coefficients_hz}};
  }
  if (model.thermal_time_constant_s) thermal = Json{{"time_constant_s", *model.thermal_time_constant_s}};
  if (model.bias) {
    Json terms = Json::object();
    for (std::size_t i = 0; i < kBiasTerms.size(); ++i)
      terms[std::string(kBiasTerms[i])] = model.bias->terms_dph[i];
    bias = Json{{"reference_hz", model.bias->reference_hz}, {"terms_dph", terms}};
  }
  if (!model.noise.empty()) {
    noise = Json::object();
    for (const auto& [key, part] : model.noise) (*noise)[key] = to_json(part);
  }
  if (model.bench) {
    bench = Json{{"gain", model.bench->gain},
                 {"damping_per_s", model.bench->damping_per_s},
                 {"stiffness_per_s2", model.bench->stiffness_per_s2},
                 {"constant_force", model.bench->constant_force}};
  }
  put(document, "frequency", frequency);
  put(document, "thermal", thermal);
  put(document, "bias", bias);
  if (!model.bench || document.contains("scale_factor")) document["scale_factor"] = model.scale_factor;
  put(document, "drive", voltage(model.drive));
  put(document, "quadrature", voltage(model.quadrature));
  if (!model.bench || document.contains("amplitude"))
    document["amplitude"]["setpoint"] = model.amplitude_setpoint;
  put(document, "noise", noise);
  put(document, "bench", bench);
  document.erase("effects");
  if (!model.effects.is_null()) document["effects"] = model.effects;
  return document;
}

void write_model(const std::string& path, const InstrumentModel& model) {
  write_text(path, json_text(to_json(model), 2) + "\n");
}

}  // namespace hemi::recording

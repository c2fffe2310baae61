// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/write.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "cli/recording/channels.hpp"
#include "cli/recording/model.hpp"
#include "cli/recording/write.hpp"

namespace hemi::prove {
namespace {

using concealed::Case;
using concealed::Series;
using recording::Json;

/// Not the case's number, which would tell its class.
std::string device(const Case& hidden) {
  const double coefficient = hidden.unit.model.frequency_hz[1] * 1e9;
  return fmt::format("HRG-{:03}", static_cast<unsigned>(std::fmod(coefficient, 1000.0)));
}

void add_channel(recording::Recording& file, const Case& hidden, const std::string& name,
                 const Series& values) {
  recording::Channel channel{name, std::string(recording::find_channel(name)->unit), {}};
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (hidden.kept[static_cast<std::size_t>(i)]) channel.values.push_back(values[i]);
  file.channels.push_back(std::move(channel));
}

/// White as a number, or the parts, to two digits as an engineer would state them.
Json stated_noise(const concealed::NoiseLevel& level, bool colour) {
  const auto digits = [](double value) { return std::stod(fmt::format("{:.2g}", value)); };
  if (!colour || (level.flicker == 0.0 && level.differenced == 0.0)) return digits(level.white);
  Json parts{{"white", digits(level.white)}};
  if (level.flicker > 0.0) parts["flicker"] = digits(level.flicker);
  if (level.differenced > 0.0) parts["differenced"] = digits(level.differenced);
  return parts;
}

recording::InstrumentModel model_file(const Case& hidden) {
  const concealed::Model& stated = hidden.stated;
  recording::InstrumentModel model;
  model.device = device(hidden);
  model.document["format"] = recording::kModelFormat;
  model.frequency = recording::FrequencyModel{0.0, stated.frequency_hz};
  model.thermal_time_constant_s = stated.time_constant_s;
  model.bias = recording::BiasModel{stated.reference_hz, stated.bias_dph};
  model.scale_factor = stated.scale_factor;
  model.drive = recording::VoltageModel{stated.command_reference_degc, stated.drive_v};
  model.quadrature = recording::VoltageModel{stated.command_reference_degc, stated.quadrature_v};
  return model;
}

Json pairs(const concealed::Values& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = value;
  return json;
}

Json by_channel(const std::array<double, concealed::kOutputs>& values) {
  return Json{{"frequency_hz", values[concealed::kFrequency]},
              {"drive_v", values[concealed::kDrive]},
              {"quadrature_v", values[concealed::kQuadrature]},
              {"rate_dph", values[concealed::kRate]}};
}

}  // namespace

void write_concealed(const Case& hidden, const std::string& directory, const std::string& name) {
  namespace c = concealed;
  recording::Recording file;
  file.device = device(hidden);
  file.sample_rate_hz = 1.0;
  const auto add = [&](const char* channel, const Series& values) {
    add_channel(file, hidden, channel, values);
  };
  add("time_s", (hidden.time_s * 1e6).round() / 1e6);
  add("case_temp_degc", hidden.case_degc);
  if (hidden.board_recorded) add("board_temp_degc", hidden.board_degc);
  add("rate_in_dph", hidden.in.rate_in_dph);
  if ((hidden.in.stimuli & (c::kRich | c::kTilts)) != 0u) {
    add("accel_g", (hidden.in.accel_g * 1e4).round() / 1e4);
    add("supply_v", hidden.in.supply_v);
    add("quadrature_trim_v", hidden.in.trim_v);
  }
  add("frequency_hz", hidden.written.frequency_hz);
  if (hidden.amplitude_recorded) add("amplitude", hidden.amplitude);
  add("drive_v", hidden.written.drive_v);
  add("quadrature_v", hidden.written.quadrature_v);
  add("rate_dph", hidden.written.rate_dph);
  const auto stem = (std::filesystem::path(directory) / name).string();
  recording::write_csv(stem + ".csv", file);
  Json model = recording::to_json(model_file(hidden));
  const auto noise = [&](int output) {
    return stated_noise(hidden.unit.noise[static_cast<std::size_t>(output)],
                        hidden.colour_stated[static_cast<std::size_t>(output)]);
  };
  const double step = hidden.unit.nuisance.case_step_degc;
  const double thermometer = std::hypot(hidden.unit.nuisance.case_noise_degc, step / std::sqrt(12.0));
  model["noise"] = Json{{"frequency_hz_rthz", noise(c::kFrequency)},
                        {"rate_dph_rthz", noise(c::kRate)},
                        {"drive_v_rthz", noise(c::kDrive)},
                        {"quadrature_v_rthz", noise(c::kQuadrature)},
                        {"amplitude_rthz", 1e-5},
                        {"case_temp_degc", std::stod(fmt::format("{:.2g}", thermometer))}};
  recording::write_text(stem + ".model.json", recording::json_text(model, 1) + "\n");
}

Json truth_json(const Case& hidden, const std::string& name) {
  Json json{{"name", name},
            {"cls", hidden.cls},
            {"seed", hidden.seed},
            {"index", hidden.index},
            {"scenario", hidden.in.program},
            {"stimuli", hidden.in.stimuli},
            {"changed", hidden.changed},
            {"confounders", hidden.confounders},
            {"dprime", hidden.dprime},
            {"set", hidden.set},
            {"tolerated", hidden.tolerated},
            {"noise_rms", by_channel(hidden.noise_rms)},
            {"trace_rms", by_channel(hidden.trace_rms)}};
  json["effects"] = Json::array();
  for (const auto& effect : hidden.effects) {
    json["effects"].push_back({{"id", effect.id},
                               {"form", effect.form},
                               {"channel", effect.channel},
                               {"strength", effect.strength},
                               {"dprime", effect.dprime},
                               {"dprime_beside", effect.dprime_beside},
                               {"parameters", pairs(effect.parameters)}});
  }
  json["located"] = Json::array();
  for (const auto& place : hidden.places) {
    Json stretches = Json::array();
    for (const auto& [from, to] : place.time_s) stretches.push_back({from, to});
    json["located"].push_back(
        {{"channel", place.channel}, {"share_of_misfit", place.share}, {"time_s", stretches}});
  }
  return json;
}

}  // namespace hemi::prove

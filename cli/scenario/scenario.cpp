// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/scenario.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "cli/recording/error.hpp"
#include "cli/scenario/checks.hpp"
#include "cli/scenario/instrument_fields.hpp"
#include "cli/scenario/read_effects.hpp"

namespace hemi::scenario {
namespace {

constexpr Quantity kDuration = {"s", 1e-6, 1e9};
constexpr double kOutputRateHz = 200.0;
constexpr double kLargestSeed = 9007199254740992.0;  // 2^53: whole in a double
constexpr double kMostRows = 1e7;
constexpr double kMargin_degc = 5.0;

std::string read_name(const Section& section, const std::string& path) {
  const std::string stem = std::filesystem::path(path).stem().string();
  const std::string name = section.text("name", stem);
  const bool plain = !name.empty() && name.find_first_of("/\\\n") == std::string::npos && name[0] != '.';
  if (!plain) section.refuse("name", "is no name for files", "use letters, digits, - and _");
  return name;
}

std::string read_start(const Section& section) {
  const std::string text = section.text("start", "");
  if (text.empty()) return text;
  for (const char* form : {"%4d-%2d-%2dT%2d:%2d", "%4d-%2d-%2d %2d:%2d", "%4d-%2d-%2d"}) {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0;
    const int found = std::sscanf(text.c_str(), form, &year, &month, &day, &hour, &minute);
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if ((found == 5 || found == 3) && date.ok() && hour >= 0 && hour < 24 && minute >= 0 && minute < 60)
      return text;
  }
  section.refuse("start", recording::in_quotes(text) + " is no date", "write 2026-03-01T08:00:00Z");
}

/// duration = "5 h", or duration_s = 18000, or the end of the longest profile.
double read_duration(const Section& section, double profiles_end_s) {
  const auto key = section.one_of({"duration", "duration_s"});
  if (!key.empty()) return section.quantity(key, kDuration);
  if (profiles_end_s > 0.0) return profiles_end_s;
  section.refuse("duration", "is missing, and no profile has an end", "add duration = \"1 h\"");
}

void read_mode(const Section& section, Scenario& scenario) {
  scenario.mode = section.choice("mode", {"slow", "full"}, "slow") == "full" ? Mode::full : Mode::slow;
  const bool full = scenario.mode == Mode::full;
  for (const char* key : {"engine", "adc", "raw_capture"}) {
    if (!full && section.has(key)) {
      section.refuse(key, "has no meaning in mode slow, which has no ADC and no core",
                     "add mode = \"full\", or leave it out");
    }
  }
  scenario.engine = section.choice("engine", {"ideal", "golden", "hls", "rtl", "systemc"}, "hls");
  scenario.wide = section.choice("adc", {"reference", "wide"}, "reference") == "wide";
  scenario.telemetry_rate_hz =
      section.quantity("telemetry_rate_hz", {"Hz", 1e-6, kOutputRateHz}, full ? kOutputRateHz : 1.0);
  const double outputs = kOutputRateHz / scenario.telemetry_rate_hz;
  if (full && std::abs(outputs - std::round(outputs)) > 1e-9 * outputs) {
    section.refuse(
        "telemetry_rate_hz",
        fmt::format("{:g} Hz is no whole fraction of the core's 200 Hz", scenario.telemetry_rate_hz),
        "use 200, 100, 50, 40, 20, 10, ...");
  }
}

void read_raw(const Section& section, Scenario& scenario) {
  if (!section.has("raw_capture")) return;
  const Section raw = section.section("raw_capture");
  raw.allow({"from", "to", "format"});
  scenario.raw = RawStretch{raw.quantity("from", {"s", 0.0, 1e9}, 0.0),
                            raw.quantity("to", {"s", 0.0, 1e9}, scenario.duration_s),
                            raw.choice("format", {"csv", "wav", "h5", "mat"}, "csv")};
  if (!(scenario.raw->from_s < scenario.raw->to_s))
    raw.refuse("to", "is not later than from", "exchange the two");
  if (scenario.raw->to_s > scenario.duration_s) {
    raw.refuse(
        "to",
        fmt::format("{:g} s is after the end of the run, {:g} s", scenario.raw->to_s, scenario.duration_s),
        "end it earlier, or make the run longer");
  }
}

void read_scenario_section(const Section& section, Scenario& scenario) {
  section.allow({"name", "device", "start", "mode", "engine", "adc", "duration", "duration_s",
                 "telemetry_rate_hz", "seed", "noise", "raw_capture"});
  scenario.name = read_name(section, scenario.path);
  scenario.device = section.text("device", "simulated");
  scenario.started = read_start(section);
  read_mode(section, scenario);
  scenario.duration_s = read_duration(section, scenario.inputs.end_s());
  const double rows = scenario.duration_s * scenario.telemetry_rate_hz;
  if (!(rows >= 2.0 && rows <= kMostRows)) {
    section.refuse(section.one_of({"duration", "duration_s"}),
                   fmt::format("{:g} s at {:g} Hz are {:g} rows", scenario.duration_s,
                               scenario.telemetry_rate_hz, std::floor(rows)),
                   fmt::format("choose duration and telemetry_rate_hz for 2 to {:g} rows", kMostRows));
  }
  const double seed = section.quantity("seed", {"1", 0.0, kLargestSeed}, 1.0);
  if (seed != std::floor(seed)) section.refuse("seed", "is no whole number", "write 1, 2, ...");
  scenario.seed = static_cast<std::uint64_t>(seed);
  scenario.noise = section.flag("noise", true);
  read_raw(section, scenario);
}

void read_loops(const Section& file, Scenario& scenario) {
  const Section loops = file.section("loops");
  loops.allow({"reference_phase_hz", "rebalance_hz", "quadrature_hz", "amplitude_hz"});
  const Quantity bandwidth = {"Hz", 1e-4, 2500.0};
  LoopBandwidths& b = scenario.loops;
  b.reference_phase_hz = loops.quantity("reference_phase_hz", bandwidth, b.reference_phase_hz);
  b.rebalance_hz = loops.quantity("rebalance_hz", bandwidth, b.rebalance_hz);
  b.quadrature_hz = loops.quantity("quadrature_hz", bandwidth, b.quadrature_hz);
  b.amplitude_hz = loops.quantity("amplitude_hz", bandwidth, b.amplitude_hz);
}

/// How the full-rate plant starts; the slow one starts settled.
void read_vibration(const Section& file, Scenario& scenario) {
  if (scenario.mode == Mode::slow && file.has("vibration")) {
    file.refuse("vibration", "has no meaning in mode slow, which starts settled",
                "add mode = \"full\" to [scenario], or leave the section out");
  }
  const Section vibration = file.section("vibration");
  vibration.allow({"amplitude", "phase_deg"});
  StartVibration& v = scenario.vibration;
  v.amplitude = vibration.quantity("amplitude", {"1", 0.0, 1.2}, v.amplitude);
  v.phase_deg = vibration.quantity("phase_deg", {"deg", -360.0, 360.0}, v.phase_deg);
}

/// [instrument]: nominal, then the model file, then single fields.
void read_instrument_section(const Section& section, Scenario& scenario) {
  physics::Instrument base;
  const std::string model_name = section.text("model", "");
  if (!model_name.empty()) {
    scenario.model_path = (std::filesystem::path(scenario.path).parent_path() / model_name).string();
    const auto model = recording::read_model(scenario.model_path);
    base = instrument_of(model, base, scenario.temperatures());
    scenario.inputs.scale_factor = model.scale_factor;
    if (!model.device.empty() && scenario.device == "simulated") scenario.device = model.device;
    for (auto& effect : effects_of(model))
      scenario.effects.push_back(completed_effect(effect, {scenario.model_path, "effects", 0}));
  }
  scenario.instrument = read_instrument(section, base);
}

}  // namespace

std::size_t Scenario::rows() const {
  return static_cast<std::size_t>(std::floor(duration_s * telemetry_rate_hz * (1.0 + 1e-12)));
}

TemperatureRange Scenario::temperatures() const {
  const auto [low, high] = inputs.chamber_degc.range(duration_s);
  return {low - kMargin_degc, high + kMargin_degc};
}

recording::InstrumentModel Scenario::nominal_model() const {
  recording::InstrumentModel model = scenario::nominal_model(
      instrument, inputs.setpoint.value(0.0), inputs.scale_factor, temperatures(),
      {1.0 / telemetry_rate_hz, {loops.rebalance_hz, loops.quadrature_hz, loops.amplitude_hz}});
  model.device = device;
  return model;
}

Scenario read_scenario(const std::string& path) {
  const Value document = read_toml(path);
  const Section file(std::get<Table>(document.content), {path, "", 1});
  std::vector<std::string_view> known = {"scenario", "instrument", "loops", "vibration", "effect"};
  known.insert(known.end(), kInputSections.begin(), kInputSections.end());
  file.allow(known);
  Scenario scenario;
  scenario.path = path;
  scenario.inputs = read_inputs(file);
  read_scenario_section(file.section("scenario"), scenario);
  read_loops(file, scenario);
  read_vibration(file, scenario);
  read_instrument_section(file.section("instrument"), scenario);
  check_physics(scenario, file);
  for (auto& effect : read_effects(file, scenario.instrument)) scenario.effects.push_back(std::move(effect));
  return scenario;
}

}  // namespace hemi::scenario

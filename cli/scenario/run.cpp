// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/run.hpp"

#include <array>
#include <stdexcept>

#include "cli/recording/channels.hpp"
#include "cli/recording/interrupt.hpp"
#include "golden/physics/slow_twin.hpp"

namespace hemi::scenario {
namespace {

using physics::TelemetrySample;

struct Member {
  const char* channel;
  double TelemetrySample::*value;
};
constexpr std::array kMembers = {Member{"time_s", &TelemetrySample::time_s},
                                 Member{"case_temp_degc", &TelemetrySample::case_temp_degc},
                                 Member{"board_temp_degc", &TelemetrySample::board_temp_degc},
                                 Member{"rate_in_dph", &TelemetrySample::rate_in_dph},
                                 Member{"accel_g", &TelemetrySample::accel_g},
                                 Member{"supply_v", &TelemetrySample::supply_v},
                                 Member{"quadrature_trim_v", &TelemetrySample::quadrature_trim_v},
                                 Member{"frequency_hz", &TelemetrySample::frequency_hz},
                                 Member{"amplitude", &TelemetrySample::amplitude},
                                 Member{"drive_v", &TelemetrySample::drive_v},
                                 Member{"quadrature_v", &TelemetrySample::quadrature_v},
                                 Member{"rate_dph", &TelemetrySample::rate_dph}};

void add(recording::Recording& out, const char* name, std::vector<double> values) {
  if (values.empty()) return;
  out.channels.push_back({name, std::string(recording::find_channel(name)->unit), std::move(values)});
}

recording::Json provenance(const Scenario& scenario) {
  const bool full = scenario.mode == Mode::full;
  recording::Json json = {{"scenario", scenario.path},
                          {"mode", full ? "full" : "slow"},
                          {"seed", scenario.seed},
                          {"noise", scenario.noise}};
  if (full) json["engine"] = scenario.engine;
  return json;
}

}  // namespace

Simulated simulate_slow(const Scenario& scenario) {
  const auto profile = [&](double time_s) {
    recording::check_interrupt();
    return scenario.inputs.at(time_s);
  };
  physics::SlowTwinOptions options;
  options.noise = scenario.noise;
  options.seed = scenario.seed;
  options.loops = {scenario.loops.rebalance_hz, scenario.loops.quadrature_hz, scenario.loops.amplitude_hz};
  Simulated simulated;
  try {
    simulated.telemetry = physics::simulate_slow(
        scenario.instrument, scenario.effects,
        physics::sample_inputs(profile, 0.0, 1.0 / scenario.telemetry_rate_hz, scenario.rows()), options);
  } catch (const std::invalid_argument& error) {
    refuse({scenario.path, "effect", 0}, error.what(), "change the effect or the inputs it depends on");
  }
  return simulated;
}

recording::Recording to_recording(const Simulated& simulated, const Scenario& scenario) {
  recording::Recording out;
  out.device = scenario.device;
  out.sample_rate_hz = scenario.telemetry_rate_hz;
  for (const Member& member : kMembers) {
    // The instrument felt the rate times its scale factor; the table's own encoder tells the rate.
    const double scale =
        member.value == &TelemetrySample::rate_in_dph ? 1.0 / scenario.inputs.scale_factor : 1.0;
    std::vector<double> values;
    values.reserve(simulated.telemetry.size());
    for (const TelemetrySample& sample : simulated.telemetry)
      values.push_back(scale * (sample.*member.value));
    add(out, member.channel, std::move(values));
  }
  add(out, "temperature_degc", simulated.temperature_degc);
  add(out, "compensated_rate_dph", simulated.compensated_rate_dph);
  add(out, "status", simulated.status);
  if (!scenario.started.empty()) out.sidecar["started"] = scenario.started;
  out.sidecar["notes"] = "simulated by hemi";
  out.sidecar["simulation"] = provenance(scenario);
  if (simulated.raw) {
    out.sidecar["raw"] = {{"sample_rate_hz", simulated.raw->sample_rate_hz},
                          {"full_scale_lsb", simulated.raw->full_scale_lsb},
                          {"start_s", scenario.raw->from_s}};
  }
  return out;
}

}  // namespace hemi::scenario

// SPDX-License-Identifier: Apache-2.0
#include "cli/output.hpp"

#include <cmath>
#include <limits>

#include "golden/loops/control.hpp"

namespace hemi::cli {
namespace {

constexpr double ticks_averaged = 2.0 * config::ticks_per_output;

}  // namespace

double full_scale_amplitude(const Sampling& sampling) {
  return loops::full_scale_amplitude(sampling.decimation);
}

double output_time_s(std::size_t output, const Setup& setup) {
  const double ticks = static_cast<double>(output) * config::ticks_per_output - 4.0;
  return ticks / config::ticks_per_output * setup.output_period_s;
}

recording::Recording to_recording(const std::vector<tb::Record>& records, const std::vector<double>& time_s,
                                  const Setup& setup, bool telemetry) {
  const double amplitude_scale =
      1.0 / (ticks_averaged * full_scale_amplitude(sampling(setup.wide)) * nominal_amplitude);
  const double none = std::numeric_limits<double>::quiet_NaN();
  recording::Recording out;
  out.sample_rate_hz = 1.0 / setup.output_period_s;
  out.channels = {{"time_s", "s", time_s}};
  auto add = [&](const char* name, const char* unit, auto value) {
    recording::Channel channel{name, unit, {}};
    channel.values.reserve(records.size());
    for (const tb::Record& record : records) channel.values.push_back(value(record.words));
    out.channels.push_back(std::move(channel));
  };
  using Words = decltype(tb::Record::words);
  add("frequency_hz", "Hz", [&](const Words& w) { return w[config::word_frequency] / setup.rate_ratio; });
  add("temperature_degc", "degC",
      [&](const Words& w) { return setup.has_thermometer ? w[config::word_temperature] : none; });
  add("dfdt_hz_per_s", "Hz/s",
      [&](const Words& w) { return w[config::word_derivative] * derivative_full_scale_hz_per_s; });
  add("amplitude", "1",
      [&](const Words& w) { return telemetry ? none : w[config::word_amplitude] * amplitude_scale; });
  add("phase_error_turns", "turn",
      [&](const Words& w) { return telemetry ? none : w[config::word_phase_error] / ticks_averaged; });
  add("bias_dph", "deg/h", [](const Words& w) { return w[config::word_bias]; });
  add("rate_dph", "deg/h", [](const Words& w) { return w[config::word_rate]; });
  add("compensated_rate_dph", "deg/h", [](const Words& w) { return w[config::word_compensated]; });
  add("status", "1", [](const Words& w) { return w[config::word_status]; });
  return out;
}

}  // namespace hemi::cli

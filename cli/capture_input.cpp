// SPDX-License-Identifier: Apache-2.0
#include "cli/capture_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "cli/chain_run.hpp"
#include "cli/output.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/model.hpp"
#include "cli/scenario/model_instrument.hpp"
#include "cli/settings.hpp"
#include "golden/loops/control.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

using recording::InputError;
using recording::Json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kTicksAveraged = 2.0 * config::ticks_per_output;

/// How a channel of the telemetry comes from a word: value = word * scale.
struct WordScale {
  const char* channel;
  config::RecordWord word;
  double scale;
};

std::vector<WordScale> word_scales(const physics::Instrument& instrument, const loops::ControlDesign& design,
                                   double rate_ratio) {
  return {{"frequency_hz", config::word_frequency, 1.0 / rate_ratio},
          {"temperature_degc", config::word_temperature, 1.0},
          {"amplitude", config::word_amplitude, 1.0 / (kTicksAveraged * design.amplitude_word)},
          {"drive_v", config::word_drive, instrument.drive_full_scale_v * design.hold_gain / kTicksAveraged},
          {"quadrature_v", config::word_quadrature, -instrument.quadrature_full_scale_v / kTicksAveraged},
          {"rate_dph", config::word_rate, 1.0},
          {"compensated_rate_dph", config::word_compensated, 1.0},
          {"status", config::word_status, 1.0}};
}

/// Registers of the design, changed by what the sidecar says of them.
void take_registers(const Json& sidecar, const std::string& path, tb::RegisterValues& values) {
  if (!sidecar.contains("registers")) return;
  const Json& stated = sidecar["registers"];
  if (!stated.is_object())
    throw InputError({.path = path, .channel = "registers"}, "is no object", "write {\"name\": value, ...}");
  for (const auto& [name, value] : stated.items()) {
    int index = 0;
    while (index < config::register_count && name != config::registers[index].name) ++index;
    if (index == config::register_count)
      throw InputError({.path = path, .channel = "registers." + name}, "the core has no such register",
                       "see docs/chain.md for their names");
    if (!value.is_number())
      throw InputError({.path = path, .channel = "registers." + name}, "is no number",
                       "give its value in the register's unit");
    values[static_cast<std::size_t>(index)] = value.get<double>();
  }
  try {
    tb::to_image(values);
  } catch (const tb::FormatError& error) {
    throw InputError({.path = path, .channel = "registers"}, error.what(), "correct the value");
  }
}

double start_of(const Json& sidecar, const std::string& path) {
  if (!sidecar.contains("raw") || !sidecar["raw"].is_object() || !sidecar["raw"].contains("start_s"))
    return 0.0;
  const Json& start = sidecar["raw"]["start_s"];
  if (!start.is_number() || !(start.get<double>() >= 0.0))
    throw InputError({.path = path, .channel = "raw.start_s"}, "is no time",
                     "give the capture's start in seconds after the core's reset");
  return start.get<double>();
}

/// Rows to outputs of the core; false where the telemetry is slower and holds means.
bool take_records(const recording::Recording& telemetry, const Setup& setup,
                  const std::vector<WordScale>& scales, std::size_t outputs,
                  diagnosis::RecordedWords& recorded) {
  const double rate_hz = 1.0 / setup.output_period_s;
  if (std::abs(telemetry.sample_rate_hz / rate_hz - 1.0) > 1e-3) return false;
  diagnosis::CoreWords none;
  none.fill(kNone);
  recorded.records.assign(outputs, none);
  // The written number is that of the word to a few units of a double's last place; a quarter of the word's
  // own last place is far above that and below any difference.
  for (std::size_t w = 0; w < config::record_words; ++w)
    recorded.tolerance[w] = std::ldexp(0.25, -tb::record_formats[w].fraction);
  const auto& time = telemetry.require("time_s", "the order of the records");
  bool any = false;
  for (const WordScale& scale : scales) {
    const auto* channel = telemetry.find(scale.channel);
    if (channel == nullptr) continue;
    any = true;
    for (std::size_t row = 0; row < time.size(); ++row) {
      const double place = (time[row] - output_time_s(0, setup)) / setup.output_period_s;
      const double output = std::round(place);
      if (std::abs(place - output) > 0.01 || output < 0.0 || output >= static_cast<double>(outputs)) continue;
      recorded.records[static_cast<std::size_t>(output)][scale.word] = channel->values[row] / scale.scale;
    }
  }
  if (!any)
    throw InputError({.path = telemetry.path},
                     "holds no word of the core (frequency_hz, amplitude, drive_v, quadrature_v, rate_dph)",
                     "give the telemetry of the same run");
  return true;
}

void take_samples(const recording::RawCapture& raw, CaptureInput& input) {
  if (std::all_of(raw.adc_y.begin(), raw.adc_y.end(), [](std::int32_t v) { return v == 0; }))
    throw InputError({.path = raw.path, .channel = "adc_y"}, "holds nothing but zeros",
                     "capture both pickoffs");
  if (!raw.gaps.empty())
    throw InputError({.path = raw.path, .channel = "adc_x"},
                     fmt::format("samples are missing after sample {}", raw.gaps.front().after_row + 1),
                     "capture again without gaps, or give the part before the gap");
  const auto count = static_cast<Eigen::Index>(raw.adc_x.size());
  input.pairs = sample_pairs(raw);
  input.capture.x_lsb.resize(count);
  input.capture.y_lsb.resize(count);
  for (Eigen::Index n = 0; n < count; ++n) {
    input.capture.x_lsb[n] = raw.adc_x[static_cast<std::size_t>(n)];
    input.capture.y_lsb[n] = raw.adc_y[static_cast<std::size_t>(n)];
  }
  input.capture.sample_rate_hz = raw.sample_rate_hz;
  input.capture.full_scale_lsb = raw.full_scale_lsb;
}

}  // namespace

CaptureInput read_capture_input(const CaptureOptions& options) {
  CaptureInput input;
  recording::RawOptions stated;
  stated.sample_rate_hz = options.adc_rate_hz;
  const auto raw = recording::read_raw_capture(options.capture, stated);
  input.notes = raw.notes;
  physics::Instrument instrument;
  recording::InstrumentModel model;
  if (!options.model.empty()) {
    model = recording::read_model(options.model);
    instrument = scenario::instrument_of(model, instrument, {});
  } else {
    input.notes.push_back("no model: the nominal instrument is taken");
    model = scenario::nominal_model(instrument, 1.0, 1.0, {}, {});
  }
  const Setup setup = capture_setup(raw, &model, std::nullopt, std::nullopt);
  input.wide = setup.wide;
  take_samples(raw, input);
  const auto sampling_of_core = setup.wide ? loops::CoreSampling::wide() : loops::CoreSampling::reference();
  loops::ControlWishes wishes;
  wishes.amplitude_setpoint = model.amplitude_setpoint;
  tb::RegisterValues values = setup.values;
  loops::set_control(values, instrument, sampling_of_core, wishes);
  const auto& p = instrument.at(20.0);
  input.nominal = {instrument.pickoff_full_scale_per_amplitude, p.drive_per_s, p.rebalance_per_s};
  auto& recorded = input.capture.recorded;
  recorded.samples_a_record =
      static_cast<std::size_t>(sampling(setup.wide).decimation) * config::ticks_per_output;
  if (!options.telemetry.empty()) {
    const auto telemetry = recording::read_recording(options.telemetry);
    take_registers(telemetry.sidecar, options.telemetry, values);
    input.capture.from_reset = start_of(telemetry.sidecar, options.telemetry) == 0.0;
    const auto scales = word_scales(instrument, loops::design_control(instrument, sampling_of_core, wishes),
                                    setup.rate_ratio);
    if (input.capture.from_reset &&
        !take_records(telemetry, setup, scales, raw.adc_x.size() / recorded.samples_a_record, recorded))
      input.notes.push_back(
          fmt::format("{}: telemetry at {:g} Hz holds means of the core's records, which come at {:g} Hz: "
                      "the core is not judged",
                      options.telemetry, telemetry.sample_rate_hz, 1.0 / setup.output_period_s));
  }
  input.capture.registers = values;
  return input;
}

}  // namespace hemi::cli

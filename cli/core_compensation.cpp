// SPDX-License-Identifier: Apache-2.0
#include "cli/core_compensation.hpp"

#include <cmath>
#include <limits>

#include "cli/settings.hpp"
#include "tb/hls_engine.hpp"

namespace hemi::cli {

using diagnosis::Output;

double core_derivative_late_s() {
  const Sampling core = sampling(false);
  const double output_rate_hz = core.adc_rate_hz / (core.decimation * config::ticks_per_output);
  // What the registers say of the window depends on the rate alone.
  recording::InstrumentModel any;
  any.frequency = recording::FrequencyModel{0.0, {4425.0, 0.4}};
  const double window_s = telemetry_setup(output_rate_hz, any, std::nullopt).derivative_window_s;
  return 0.5 * window_s * (1.0 + 1.0 / config::derivative_blocks);
}

recording::InstrumentModel core_model(const recording::InstrumentModel& corrected,
                                      const diagnosis::CoreCorrection& correction) {
  recording::InstrumentModel model = corrected;
  model.effects = recording::Json();
  model.document.erase("effects");
  model.scale_factor = correction.model.scale_factor;
  model.bias->terms_dph = correction.model.bias_dph;
  model.frequency->coefficients_hz = correction.model.frequency_hz.coefficients;
  if (correction.frequency_changed)
    model.document["frequency"]["calibrated_degc"] = {correction.low_degc, correction.high_degc};
  return model;
}

CoreRun run_core(const diagnosis::Telemetry& telemetry, const recording::InstrumentModel& model) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Setup setup = telemetry_setup(1.0 / telemetry.step_s, model, std::nullopt);
  const auto engine = tb::make_hls_engine(setup.wide);
  engine->reset(setup.values);
  const auto& frequency = telemetry[Output::frequency];
  const auto& rate = telemetry[Output::rate];
  CoreRun run{Eigen::VectorXd::Constant(telemetry.rows(), none), {}};
  run.temperature_degc = run.residual_dph;
  std::vector<tb::Record> records;
  double last_hz = model.bias->reference_hz;
  for (Eigen::Index i = 0; i < telemetry.rows(); ++i) {
    const bool valid = !std::isnan(frequency[i]);
    if (valid) last_hz = frequency[i];
    records.clear();
    engine->telemetry(last_hz * setup.rate_ratio, std::isnan(rate[i]) ? 0.0 : rate[i], valid, records);
    if (!valid) continue;
    const auto& words = records.at(0).words;
    run.temperature_degc[i] = words[config::word_temperature];
    const auto status = static_cast<std::uint64_t>(words[config::word_status]);
    const bool filled = (status >> config::status_derivative_invalid & 1U) == 0;
    if (filled && !std::isnan(rate[i]))
      run.residual_dph[i] = words[config::word_compensated] - telemetry.rate_in_dph[i];
  }
  return run;
}

}  // namespace hemi::cli

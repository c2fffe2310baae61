// SPDX-License-Identifier: Apache-2.0
// From an instrument model and a recording's rates to the register values of the core.
#ifndef HEMI_CLI_SETTINGS_HPP
#define HEMI_CLI_SETTINGS_HPP

#include <optional>
#include <string>
#include <vector>

#include "cli/recording/model.hpp"
#include "cli/recording/raw_capture.hpp"
#include "tb/engine.hpp"

namespace hemi::cli {

/// df/dt at full scale of the derivative word [Hz/s]: 30 times the fastest chamber ramp of the paper.
inline constexpr double derivative_full_scale_hz_per_s = 0.125;

/// Amplitude 1 in recordings is the nominal set point: this share of the ADC's full scale.
inline constexpr double nominal_amplitude = 0.8;

/// The core's registers for one job, and what its words mean in that job's own units.
struct Setup {
  bool wide = false;             ///< instrument: config::Wide, else config::Reference
  double rate_ratio = 1.0;       ///< nominal ADC rate / ADC rate: nominal Hz = Hz * rate_ratio
  double output_period_s = 0.0;  ///< between records
  double derivative_window_s = 0.0;
  bool has_thermometer = false;         ///< false: no model, the temperature word means nothing
  double thermometer_error_degc = 0.0;  ///< largest error of the inverse polynomial in the calibrated range
  tb::RegisterValues values{};
  std::vector<std::string> notes;
};

/// Sampling of one of the two instruments.
struct Sampling {
  int adc_bits;
  double adc_rate_hz;
  int decimation;
};
Sampling sampling(bool wide);

/// Raw capture: registers of the whole chain. The nco starts at `start_hz`, or at the model's frequency at 20
/// degC. InputError for a capture that no instrument fits: bits, rate, start frequency.
Setup capture_setup(const recording::RawCapture& capture, const recording::InstrumentModel* model,
                    std::optional<double> start_hz, std::optional<double> window_s);

/// Telemetry at `sample_rate_hz`: thermometer, derivative and bias model.
Setup telemetry_setup(double sample_rate_hz, const recording::InstrumentModel& model,
                      std::optional<double> window_s);

}  // namespace hemi::cli

#endif  // HEMI_CLI_SETTINGS_HPP

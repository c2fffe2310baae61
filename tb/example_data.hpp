// SPDX-License-Identifier: Apache-2.0
// Recordings to try the program on: raw captures and chamber runs of an instrument whose physics is written
// here.
#ifndef HEMI_TB_EXAMPLE_DATA_HPP
#define HEMI_TB_EXAMPLE_DATA_HPP

#include <cstdint>
#include <limits>

#include "cli/recording/raw_capture.hpp"
#include "cli/recording/recording.hpp"

namespace hemi::examples {

/// A ringing resonator in front of one of the two instruments' ADCs.
struct CaptureOptions {
  bool wide = false;  ///< 18 bits at 250 kS/s instead of 16 bits at 100 kS/s
  double seconds = 5.0;
  std::uint64_t seed = 1;
  double noise_lsb = 0.5;         ///< white, rms, each pickoff
  double offset_hz = 0.0;         ///< frequency at the start less 4425 Hz
  double drift_hz_per_s = 0.001;  ///< constant; 1 mHz/s is 0.16 degC a minute at 0.37 Hz/degC
  double damping_s = std::numeric_limits<double>::infinity();  ///< time constant of the amplitude
  double gaps_per_s = 0.0;  ///< mean number of places a second where 1 to 100 samples are lost
};

/// adc_x = 0.8 a cos(theta), adc_y = 0.8 a (0.02 cos(theta) - 0.05 sin(theta)) of full scale, a = exp(-t /
/// damping), theta = 2 pi (f0 t + drift t^2 / 2); Gaussian noise added, rounded to nearest, clipped at the
/// rails.
recording::RawCapture make_capture(const CaptureOptions& options);

/// cool: 23 to -20 degC at 1 degC/min; cycle: 23 to -10 degC at 0.5 degC/min and back; warm: -20 to 40 degC
/// at 1 degC/min. Each starts settled, holds for ten minutes and lasts five hours.
enum class ChamberProfile { cool, cycle, warm };

/// Telemetry at 1 Hz: time_s, case_temp_degc, frequency_hz, rate_dph; the instrument is at rest.
///
///   housing    dT_c/dt = (chamber - T_c) / 300 s
///   resonator  dT/dt = (T_c - T) / 2600 s                      the paper: settled about 15 000 s after a
///   step mount      dT_m/dt = (T_c - T_m) / 400 s frequency  f(T): quartic through Table 1 of the paper; +
///   white noise, 2e-5 Hz per root Hz rate       B(f - 4432.07 Hz, df/dt), terms of Eq. (21): 1, f, f^2, f^3,
///   f', f'^2, f f'
///              + 0.15 deg/h per degC of T_c - T_m              a thermal gradient, which Eq. (21) cannot
///              express
///              + white noise, 0.6 deg/h per root Hz + flicker noise, 0.03 deg/h per root Hz at 1 Hz
///   thermometer on the housing: T_c + white noise, 0.01 degC a sample
///
/// Each node is stepped exactly for a temperature ahead of it that is constant over a sample.
recording::Recording make_chamber_run(ChamberProfile profile, std::uint64_t seed);

}  // namespace hemi::examples

#endif  // HEMI_TB_EXAMPLE_DATA_HPP

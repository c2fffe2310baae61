// SPDX-License-Identifier: Apache-2.0
// From the core's records to the columns that `hemi run` writes.
#ifndef HEMI_CLI_OUTPUT_HPP
#define HEMI_CLI_OUTPUT_HPP

#include <vector>

#include "cli/recording/recording.hpp"
#include "cli/settings.hpp"

namespace hemi::cli {

/// Amplitude word of a pickoff signal of full scale; docs/chain.md, phase_detector.
double full_scale_amplitude(const Sampling& sampling);

/// Time of output m of a capture [s], from its first sample.
double output_time_s(std::size_t output, const Setup& setup);

/// time_s, frequency_hz, temperature_degc, dfdt_hz_per_s, amplitude, phase_error_turns, bias_dph, rate_dph,
/// compensated_rate_dph, status. Every conversion is one-to-one, so that equal files mean equal words.
recording::Recording to_recording(const std::vector<tb::Record>& records, const std::vector<double>& time_s,
                                  const Setup& setup, bool telemetry);

}  // namespace hemi::cli

#endif  // HEMI_CLI_OUTPUT_HPP

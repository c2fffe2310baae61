// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/recording/raw_capture.hpp"

namespace hemi::scenario {

/// A capture of 16 bits as a WAV file of two channels, whole or not at all. OutputError where it cannot be
/// written; std::invalid_argument for another full scale or a rate that is no whole number.
void write_wav(const std::string& path, const recording::RawCapture& capture);

}  // namespace hemi::scenario

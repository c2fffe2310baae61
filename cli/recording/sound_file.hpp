// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hemi::recording {

/// Integer samples of a sound file, exactly as stored.
struct Sound {
  double sample_rate_hz = 0.0;
  double full_scale_lsb = 0.0;  ///< 2^(bits - 1) of the file's samples
  std::vector<std::int32_t> x{};
  std::vector<std::int32_t> y{};  ///< empty in a file of one channel
};

/// WAV, FLAC, AIFF and whatever else libsndfile reads with 8-, 16-, 24- or 32-bit PCM samples. InputError: no
/// sound, floating-point or lossy samples, more than two channels, nothing in it, cut off.
Sound read_sound(const std::string& path);

}  // namespace hemi::recording

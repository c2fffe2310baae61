// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/wav_write.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "cli/recording/error.hpp"
#include "cli/recording/partial_file.hpp"

namespace hemi::scenario {
namespace {

constexpr std::uint32_t kChannels = 2;
constexpr std::uint32_t kBytes = 2;
constexpr std::uint32_t kHeaderAfterSize = 36;

void put(std::string& text, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) text.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

}  // namespace

void write_wav(const std::string& path, const recording::RawCapture& capture) {
  if (capture.full_scale_lsb != 32768.0 || capture.sample_rate_hz != std::floor(capture.sample_rate_hz))
    throw std::invalid_argument("WAV: samples of 16 bits at a whole rate alone");
  // The header counts bytes in 32 bits.
  constexpr std::size_t kMostPairs =
      (std::numeric_limits<std::uint32_t>::max() - kHeaderAfterSize) / (kChannels * kBytes);
  if (capture.adc_x.size() > kMostPairs)
    throw recording::OutputError(path, "more samples than the 4 GiB of a WAV file hold",
                                 "take a shorter stretch, or format = \"h5\"");
  const auto rate = static_cast<std::uint32_t>(capture.sample_rate_hz);
  const auto size = static_cast<std::uint32_t>(capture.adc_x.size()) * kChannels * kBytes;
  std::string text = "RIFF";
  put(text, kHeaderAfterSize + size, 4);
  text += "WAVEfmt ";
  put(text, 16, 4);
  put(text, 1, 2);  // PCM
  put(text, kChannels, 2);
  put(text, rate, 4);
  put(text, rate * kChannels * kBytes, 4);
  put(text, kChannels * kBytes, 2);
  put(text, 8 * kBytes, 2);
  text += "data";
  put(text, size, 4);
  for (std::size_t i = 0; i < capture.adc_x.size(); ++i) {
    put(text, static_cast<std::uint32_t>(capture.adc_x[i]), kBytes);
    put(text, static_cast<std::uint32_t>(capture.adc_y[i]), kBytes);
  }
  recording::PartialFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace hemi::scenario

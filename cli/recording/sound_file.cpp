// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/sound_file.hpp"

#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>

#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"

namespace hemi::recording {
namespace {

using SoundHandle = std::unique_ptr<SNDFILE, int (*)(SNDFILE*)>;

// Bits of one stored sample; 0: not stored as integers without loss.
int sample_bits(int format) {
  switch (format & SF_FORMAT_SUBMASK) {
    case SF_FORMAT_PCM_S8:
    case SF_FORMAT_PCM_U8:
      return 8;
    case SF_FORMAT_PCM_16:
    case SF_FORMAT_ALAC_16:
      return 16;
    case SF_FORMAT_PCM_24:
    case SF_FORMAT_ALAC_24:
      return 24;
    case SF_FORMAT_PCM_32:
    case SF_FORMAT_ALAC_32:
      return 32;
    default:
      return 0;
  }
}

[[noreturn]] void cut_off(const std::string& path) {
  throw InputError({.path = path}, "the sound file is cut off", "copy or record it again");
}

// libsndfile shortens a WAV file that ends too early without a word; the RIFF header tells the whole length.
void check_riff_length(const std::string& path) {
  std::array<unsigned char, 8> head{};
  std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(head.data()), head.size());
  if (!std::equal(head.begin(), head.begin() + 4, "RIFF")) return;
  const std::uint64_t stated = head[4] | head[5] << 8 | head[6] << 16 | std::uint64_t{head[7]} << 24;
  constexpr std::uint64_t kStreamed = 0xffffffffU;  // a writer that could not go back to the header
  if (stated != 0 && stated != kStreamed && stated + 8 > std::filesystem::file_size(path)) cut_off(path);
}

void check_info(const SF_INFO& info, const std::string& path) {
  if (sample_bits(info.format) == 0) {
    throw InputError({.path = path}, "the samples are floating-point or lossy, and no ADC words",
                     "save it as 16-bit or 24-bit PCM (WAV or FLAC)");
  }
  if (info.channels > 2) {
    throw InputError({.path = path}, fmt::format("{} channels where x and y are expected", info.channels),
                     "keep the two pickoffs only");
  }
  if (info.frames <= 0) throw InputError({.path = path}, "no samples in it", "record or export it again");
}

}  // namespace

Sound read_sound(const std::string& path) {
  require_readable(path);
  SF_INFO info{};
  const SoundHandle file(sf_open(path.c_str(), SFM_READ, &info), sf_close);
  if (!file) {
    throw InputError({.path = path}, fmt::format("no sound file ({})", sf_strerror(nullptr)),
                     "give WAV or FLAC, or a name that ends as the file's kind demands");
  }
  check_info(info, path);
  check_riff_length(path);
  const int bits = sample_bits(info.format);
  const int shift = 32 - bits;  // sf_readf_int justifies to the left
  Sound sound{.sample_rate_hz = static_cast<double>(info.samplerate),
              .full_scale_lsb = static_cast<double>(std::int64_t{1} << (bits - 1))};
  constexpr sf_count_t kBlock = 1 << 16;
  const auto channels = static_cast<std::size_t>(info.channels);
  std::vector<int> block(static_cast<std::size_t>(kBlock) * channels);
  sf_count_t count = 0;
  while ((count = sf_readf_int(file.get(), block.data(), kBlock)) > 0) {
    check_interrupt();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      sound.x.push_back(block[i * channels] >> shift);
      if (channels == 2) sound.y.push_back(block[i * channels + 1] >> shift);
    }
  }
  if (sf_error(file.get()) != SF_ERR_NO_ERROR || static_cast<sf_count_t>(sound.x.size()) < info.frames) {
    cut_off(path);
  }
  return sound;
}

}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
// Top functions for HLS compilers: one call a sample pair (or telemetry sample), state inside.
//
//   reset          load `registers` and start from sample 0; the other inputs of that call are not used
//   telemetry      false: x, y (raw ADC words) and gap;  true: frequency, rate (raw words), gap means not
//   valid record_valid   `record` holds the words of config::RecordWord
#include "hls/core.hpp"

namespace {

template <class Instrument>
void step(hemi::hls::Core<Instrument>& core, bool reset,
          const std::int64_t (&registers)[hemi::config::register_count], bool telemetry, std::int32_t x,
          std::int32_t y, bool gap, std::int64_t frequency, std::int64_t rate, bool& record_valid,
          std::int64_t (&record)[hemi::config::record_words]) {
  record_valid = false;
  if (reset) {
    core.reset(registers);
    return;
  }
  hemi::hls::NoProbe probe;
  hemi::hls::Record words;
  if (telemetry) {
    core.telemetry(frequency, rate, !gap, words, probe);
    record_valid = true;
  } else {
    record_valid = core.sample(x, y, gap, words, probe);
  }
  if (!record_valid) return;
  for (int i = 0; i < hemi::config::record_words; ++i) record[i] = words.word[i];
}

}  // namespace

extern "C" void hemi_core_reference(bool reset, const std::int64_t (&registers)[hemi::config::register_count],
                                    bool telemetry, std::int32_t x, std::int32_t y, bool gap,
                                    std::int64_t frequency, std::int64_t rate, bool& record_valid,
                                    std::int64_t (&record)[hemi::config::record_words]) {
  static hemi::hls::Core<hemi::config::Reference> core;
  step(core, reset, registers, telemetry, x, y, gap, frequency, rate, record_valid, record);
}

extern "C" void hemi_core_wide(bool reset, const std::int64_t (&registers)[hemi::config::register_count],
                               bool telemetry, std::int32_t x, std::int32_t y, bool gap,
                               std::int64_t frequency, std::int64_t rate, bool& record_valid,
                               std::int64_t (&record)[hemi::config::record_words]) {
  static hemi::hls::Core<hemi::config::Wide> core;
  step(core, reset, registers, telemetry, x, y, gap, frequency, rate, record_valid, record);
}

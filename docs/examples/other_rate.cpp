// SPDX-License-Identifier: Apache-2.0
// An instrument of 14 bits at 80 kS/s, a tick every 16 samples: fixed point and double precision, record by
// record.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "golden/chain/chain.hpp"
#include "hls/core.hpp"
#include "registers.h"  // hemi export my.model.json --open-loop --format c -o registers.h

using Mine = hemi::config::Instrument<14, 80000, 16>;

int main() {
  std::int64_t image[HEMI_REGISTER_COUNT];
  hemi::golden::RegisterValues values;
  for (int i = 0; i < HEMI_REGISTER_COUNT; ++i) image[i] = hemi_register_image[i];
  // Frequencies are fractions of the ADC rate: the same start in Hz is a larger one of 80 kS/s.
  image[hemi::config::reg_nco_start] = std::llround(4425.0 / Mine::adc_rate_hz * 0x1p48);
  for (int i = 0; i < HEMI_REGISTER_COUNT; ++i)
    values[i] = std::ldexp(image[i], -hemi::config::registers[i].format.fraction);

  hemi::hls::Core<Mine> core;
  core.reset(image);
  hemi::hls::NoProbe probe;
  hemi::hls::Record record;
  hemi::golden::Chain golden(hemi::golden::Precision::quantised,
                             {Mine::adc_bits, Mine::adc_rate_hz, Mine::decimation}, values);
  std::vector<hemi::golden::ChainRecord> expected;
  long records = 0, different = 0;
  double frequency_hz = 0.0;
  for (int n = 0; n < 2 * Mine::adc_rate_hz; ++n) {
    const int x = static_cast<int>(
        std::lround(6500.0 * std::sin(2.0 * std::numbers::pi * 4426.25 / Mine::adc_rate_hz * n)));
    golden.step(x, 0, false, expected);
    if (!core.sample(x, 0, false, record, probe)) continue;
    ++records;
    frequency_hz = std::ldexp(record.word[hemi::config::word_frequency], -hemi::config::frequency.fraction);
    different += frequency_hz != expected.back().words[hemi::config::word_frequency];
  }
  std::printf("%ld records, %ld different; %.4f Hz\n", records, different, frequency_hz);
}

// SPDX-License-Identifier: Apache-2.0
#include "tests/golden/chain/contract.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hemi::golden::testing {

using namespace config;

double uniform(std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(-1.0, 1.0)(random);
}

RegisterValues random_registers(const InstrumentParameters& instrument, std::mt19937_64& random, int kind) {
  RegisterValues values = reference_values(instrument, 0.04424778761 * instrument.adc_rate_hz);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Format& format = registers[i].format;
    if (kind == 0 && i <= reg_lock_count) continue;  // the loop as it is meant to be
    switch (random() % 4) {
      case 0:
        values[i] = lowest_of(format);
        break;
      case 1:
        values[i] = highest_of(format);
        break;
      default:
        values[i] = floor_to(uniform(random) * highest_of(format), format.fraction);
    }
  }
  if (kind == 0) values[reg_lock_count] = 60.0;
  values[reg_log2_block] = static_cast<double>(random() % 3);
  values[reg_slope_shift] = static_cast<double>(random() % 51);
  if (random() % 2 == 0) values[reg_frequency_reference] = 4424.0;
  if (random() % 2 == 0) values[reg_amplitude_threshold] = round_to(0.001, cordic.fraction);
  for (const RegisterIndex i :
       {reg_search_span, reg_drive_limit, reg_quadrature_limit, reg_rebalance_limit}) {
    values[i] = std::clamp(std::abs(values[i]), 0.0, highest_of(registers[i].format));
  }
  for (const RegisterIndex i : {reg_search_ticks, reg_holdover_ticks}) {
    if (random() % 2 == 0) values[i] = static_cast<double>(random() % 40);
  }
  std::array<double, 3> amplitudes = {values[reg_amplitude_threshold], values[reg_search_amplitude],
                                      values[reg_closing_amplitude]};
  std::sort(amplitudes.begin(), amplitudes.end());
  values[reg_amplitude_threshold] = amplitudes[0];
  values[reg_search_amplitude] = amplitudes[1];
  values[reg_closing_amplitude] = amplitudes[2];
  return values;
}

void expect_equal(const Recorder& recorder, const WholeNumbers& expected, const std::string& what,
                  std::uint64_t& status_seen) {
  ASSERT_EQ(recorder.taps_.size(), expected.taps.size()) << what;
  for (std::size_t i = 0; i < expected.taps.size(); ++i) {
    const auto [index, value] = recorder.taps_[i];
    ASSERT_EQ(std::ldexp(value, taps[index].format.fraction), static_cast<double>(expected.taps[i]))
        << what << ": " << taps[index].block << "." << taps[index].name << ", tap " << i;
    ASSERT_FALSE(value == 0.0 && std::signbit(value)) << what << ": -0 at " << taps[index].name;
    const double limit = std::ldexp(1.0, taps[index].format.width - 1);
    ASSERT_TRUE(-limit <= static_cast<double>(expected.taps[i]) &&
                static_cast<double>(expected.taps[i]) < limit);
    if (index == tap_status)
      status_seen |= static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << status_shift) - 1);
  }
}

void expect_sums(const Recorder& recorder, const std::vector<ChainRecord>& records, const std::string& what) {
  constexpr std::array<std::pair<TapIndex, RecordWord>, 4> kWords = {{{tap_amplitude, word_amplitude},
                                                                      {tap_phase_error, word_phase_error},
                                                                      {tap_drive, word_drive},
                                                                      {tap_quadrature, word_quadrature}}};
  for (const auto& [index, word] : kWords) {
    std::vector<double> ticks;
    for (const auto& [i, value] : recorder.taps_) {
      if (i == index) ticks.push_back(value);
    }
    ASSERT_GE(ticks.size(), records.size() * ticks_per_output);
    for (std::size_t m = 0; m < records.size(); ++m) {
      const std::size_t last = (m + 1) * ticks_per_output;
      double sum = 0.0;
      for (std::size_t k = m == 0 ? 0 : last - 2 * ticks_per_output; k < last; ++k) sum += ticks[k];
      ASSERT_EQ(records[m].words[word], sum) << what << ", " << taps[index].name << ", output " << m;
    }
  }
}

}  // namespace hemi::golden::testing

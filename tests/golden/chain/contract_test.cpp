// SPDX-License-Identifier: Apache-2.0
// Every tap of the quantised chain against whole numbers, at the extremes of inputs and registers.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/golden/chain/contract.hpp"

namespace hemi::golden::testing {
namespace {

using namespace config;

struct Stimulus {
  const char* name;
  double (*value)(std::int64_t n, std::mt19937_64& random);  // fractions of full scale, clipped at the rails
};

double tone(double amplitude, std::int64_t n) {
  return amplitude * std::cos(0.278 * static_cast<double>(n));
}

const std::array<Stimulus, 7> kStimuli = {{
    {"silence", [](std::int64_t, std::mt19937_64&) { return 0.0; }},
    {"square", [](std::int64_t n, std::mt19937_64&) { return tone(1.0, n) < 0.0 ? -1.0 : 1.0; }},
    {"slow square", [](std::int64_t n, std::mt19937_64&) { return n / 700 % 2 == 0 ? -1.0 : 1.0; }},
    {"negative rail", [](std::int64_t, std::mt19937_64&) { return -1.0; }},
    {"white", [](std::int64_t, std::mt19937_64& random) { return 1.5 * uniform(random); }},
    {"noisy tone",
     [](std::int64_t n, std::mt19937_64& random) { return tone(0.8, n) + 1e-4 * uniform(random); }},
    {"tone that fails",
     [](std::int64_t n, std::mt19937_64& random) {
       return n / 9000 % 2 == 0 ? tone(0.9, n) : 1e-5 * uniform(random);
     }},
}};

void run(const InstrumentParameters& instrument, const Stimulus& x, const Stimulus& y,
         const RegisterValues& values, std::mt19937_64& random, const std::string& what,
         std::uint64_t& status_seen) {
  constexpr Eigen::Index kOutputs = 60;
  const Eigen::Index count = kOutputs * instrument.decimation * ticks_per_output;
  Eigen::VectorXd xs(count);
  Eigen::VectorXd ys(count);
  std::vector<std::uint8_t> gap(static_cast<std::size_t>(count));
  for (Eigen::Index n = 0; n < count; ++n) {
    xs[n] = x.value(n, random);
    ys[n] = y.value(n, random);
    gap[static_cast<std::size_t>(n)] = random() % 20000 == 0;
  }
  xs = digitise(xs, instrument.adc_bits);
  ys = digitise(ys, instrument.adc_bits);
  Chain chain(Precision::quantised, instrument, values);
  Recorder recorder;
  chain.set_taps(&recorder);
  WholeNumbers expected(instrument, values);
  std::vector<ChainRecord> records;
  for (Eigen::Index done = 0; done < count;) {
    const Eigen::Index size = std::min<Eigen::Index>(count - done, static_cast<Eigen::Index>(random() % 97));
    const auto first = gap.begin() + done;
    const std::vector<std::uint8_t> part(first, first + size);
    chain.samples(xs.segment(done, size), ys.segment(done, size), &part, records);
    done += size;
  }
  for (Eigen::Index n = 0; n < count; ++n) {
    expected.sample(static_cast<std::int64_t>(xs[n]), static_cast<std::int64_t>(ys[n]),
                    gap[static_cast<std::size_t>(n)] != 0);
  }
  expect_equal(recorder, expected, what, status_seen);
  if (!::testing::Test::HasFatalFailure()) expect_sums(recorder, records, what);
}

TEST(Contract, EveryTapEqualsWholeNumbers) {
  std::mt19937_64 random(7);
  std::uint64_t status_seen = 0;
  for (const auto& instrument : {InstrumentParameters::reference(), InstrumentParameters::wide()}) {
    for (std::size_t s = 0; s < kStimuli.size(); ++s) {
      for (int kind = 0; kind < 3; ++kind) {
        const Stimulus& y = kStimuli[(s + static_cast<std::size_t>(kind)) % kStimuli.size()];
        const std::string what =
            fmt::format("{} bit, {}, {}, {}", instrument.adc_bits, kStimuli[s].name, y.name, kind);
        run(instrument, kStimuli[s], y, random_registers(instrument, random, kind), random, what,
            status_seen);
        if (HasFatalFailure()) return;
      }
    }
  }
  // Extremes that leave a bit alone would prove less than they seem to.
  for (int bit = 0; bit < status_bits; ++bit) EXPECT_TRUE(status_seen >> bit & 1) << status_names[bit];
}

TEST(Contract, ParityHoldsOverWholeImagesOnly) {
  for (const auto& instrument : {InstrumentParameters::reference(), InstrumentParameters::wide()}) {
    RegisterValues values = reference_values(instrument, 4425.0);
    EXPECT_TRUE(parity_holds(values));
    values[reg_bias_f] += power_of_two(-bias.fraction);
    EXPECT_FALSE(parity_holds(values));
  }
}

TEST(Contract, EveryTapEqualsWholeNumbersForTelemetryUpToTheRails) {
  std::mt19937_64 random(8);
  std::uint64_t status_seen = 0;
  for (int set = 0; set < 200; ++set) {
    const RegisterValues values = random_registers(InstrumentParameters::reference(), random, set % 2);
    Chain chain(Precision::quantised, InstrumentParameters::reference(), values);
    Recorder recorder;
    chain.set_taps(&recorder);
    WholeNumbers expected(InstrumentParameters::reference(), values);
    std::vector<ChainRecord> records;
    for (int m = 0; m < 200; ++m) {
      const bool wild = random() % 8 == 0;
      const double f = wild ? uniform(random) * 1.1 * highest_of(frequency)
                            : values[reg_frequency_reference] + 70.0 * std::pow(uniform(random), 3);
      const double r = uniform(random) * (wild ? 1.1 : 0.2) * highest_of(rate);
      const auto word = [](double v, const Format& format) {
        return std::clamp(round_to(v, format.fraction), lowest_of(format), highest_of(format));
      };
      const bool valid = random() % 64 != 0;
      chain.telemetry(f, r, valid, records);
      expected.telemetry(std::llround(std::ldexp(word(f, frequency), frequency.fraction)),
                         std::llround(std::ldexp(word(r, rate), rate.fraction)), valid);
    }
    expect_equal(recorder, expected, fmt::format("set {}", set), status_seen);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace hemi::golden::testing

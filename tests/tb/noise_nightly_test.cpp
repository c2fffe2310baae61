// SPDX-License-Identifier: Apache-2.0
// The whole Allan curve, 10 ms to 1000 s: seven minutes of computing for 60 000 s of the instrument.
// HEMI_NOISE_RECORDINGS=16 takes more of them (two by default), so that 1000 s can be told to a few percent.
#include <gtest/gtest.h>

#include <cstdlib>
#include <future>

#include "tb/hls_engine.hpp"
#include "tests/tb/noise_bench.hpp"
#include "tests/tb/paired_noise.hpp"

namespace {

using namespace hemi;

constexpr double kRecording_s = 30000.0;
constexpr double kLongest_s = 1400.0;

void expect_predicted(const std::vector<tests::AllanRow>& rows) {
  for (const auto& r : rows) {
    EXPECT_NEAR(r.ratio(), 1.0, std::max(0.1, 3.0 * r.sigma)) << "tau " << r.tau_s << " s";
    // A recording that could not tell 10 % up to 100 s would prove nothing.
    if (r.tau_s < 100.0) {
      EXPECT_LT(r.sigma, 0.05) << r.tau_s;
    }
  }
}

TEST(Noise, WholeAllanCurveIsThePredictedOne) {
  physics::Instrument instrument;
  instrument.oscillator_noise_rthz = 1e-10;
  const auto record = [&](std::uint64_t first, std::uint64_t step, std::uint64_t end) {
    std::vector<tests::NoiseRecording> recordings;
    for (std::uint64_t seed = first; seed < end; seed += step) {
      auto bench = tests::settled_bench(tb::make_hls_engine(false), instrument, false, seed);
      recordings.push_back(tests::record_noise(bench, kRecording_s));
    }
    return recordings;
  };
  const char* asked = std::getenv("HEMI_NOISE_RECORDINGS");
  const std::uint64_t first = 201;
  const std::uint64_t end = first + (asked != nullptr ? std::strtoull(asked, nullptr, 10) : 2);
  auto other = std::async(std::launch::async, record, first, 2, end);
  auto recordings = record(first + 1, 2, end);
  for (auto& more : other.get()) recordings.push_back(std::move(more));
  const auto budget = tests::noise_budget(instrument, false);
  const auto rate = tests::rate_rows(recordings, kLongest_s, budget);
  const auto frequency = tests::frequency_rows(recordings, kLongest_s, budget);
  tests::print_rows("rate, deg/h", rate);
  tests::print_rows("frequency, Hz", frequency);
  expect_predicted(rate);
  expect_predicted(frequency);
}

TEST(Noise, FixedPointOfTheWideInstrumentAddsLessThanOnePercent) {
  const auto shares = tests::fixed_point_shares(true, 30.0, 7);
  tests::print_shares("wide", shares);
  tests::expect_below(shares, 0.01);
}

}  // namespace

// SPDX-License-Identifier: Apache-2.0
// The slow run: same seed same file, noise of the size that the model states, channels of the format.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cli/recording/channels.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/scenario/run.hpp"
#include "tests/cli/scenario/scenario_test.hpp"

namespace hemi::scenario::testing {
namespace {

class Slow : public ScenarioTest {
 protected:
  recording::Recording run(const std::string& text) const {
    const Scenario s = read(text);
    return to_recording(simulate_slow(s), s);
  }
};

const std::string kHour = "[scenario]\nduration = \"1 h\"\n";

TEST_F(Slow, SameSeedSameNumbers) {
  const auto a = run(kHour + "seed = 7\n"), b = run(kHour + "seed = 7\n"), c = run(kHour + "seed = 8\n");
  ASSERT_EQ(a.rows(), 3600U);
  for (const auto& channel : a.channels)
    EXPECT_TRUE(recording::testing::same_values(channel.values, b.find(channel.name)->values))
        << channel.name;
  for (const char* noisy : {"frequency_hz", "rate_dph", "drive_v", "quadrature_v", "amplitude"})
    EXPECT_NE(a.find(noisy)->values, c.find(noisy)->values) << noisy;
}

TEST_F(Slow, ChannelsOfTheFormat) {
  const auto a = run(kHour + "device = \"HRG-1\"\nstart = 2026-03-01T08:00:00Z\ntelemetry_rate_hz = 2\n");
  ASSERT_EQ(a.channels.size(), 12U);
  for (const auto& channel : a.channels) EXPECT_EQ(channel.unit, recording::find_channel(channel.name)->unit);
  EXPECT_EQ(a.rows(), 7200U);
  EXPECT_EQ(a.sample_rate_hz, 2.0);
  EXPECT_EQ(a.find("time_s")->values[3], 1.5);
  EXPECT_EQ(a.device, "HRG-1");
  EXPECT_EQ(a.sidecar["started"], "2026-03-01T08:00:00Z");
  EXPECT_EQ(a.sidecar["simulation"]["seed"], 1U);
}

TEST_F(Slow, NoNoiseNoScatter) {
  const auto a = run(kHour + "noise = false\n");
  for (const char* name : {"frequency_hz", "rate_dph", "amplitude", "case_temp_degc"}) {
    const auto& values = a.find(name)->values;
    const auto [low, high] = std::ranges::minmax(values);
    // Nothing moves; what is left is rounding of the loops' arithmetic.
    EXPECT_LT(high - low, 1e-9 * std::max(1.0, std::abs(high))) << name;
  }
}

// A heater's share of the board's temperature comes behind the board's time constant, T = 300 s:
// 10 (1 - exp(-t / T)) after a step of 10 degC; case and resonator stay where they were.
TEST_F(Slow, AHeaterWarmsTheBoardAlone) {
  const std::string text =
      "[scenario]\nduration = 1200\nnoise = false\n[instrument]\nboard_time_constant_s = 300\n";
  const auto cold = run(text), warm = run(text + "[board]\nsteps = [[600, 10]]\n");
  const auto& board = warm.find("board_temp_degc")->values;
  const auto& before = cold.find("board_temp_degc")->values;
  for (std::size_t i = 0; i < board.size(); ++i) {
    const double since_s = static_cast<double>(i) - 600.0;
    const double expected = since_s < 0.0 ? 0.0 : 10.0 * -std::expm1(-since_s / 300.0);
    // A sample stands for the second around its time, in which the board moves by 10 / 300 degC at most.
    ASSERT_NEAR(board[i] - before[i], expected, 10.0 / 300.0) << i;
  }
  for (const char* name : {"case_temp_degc", "frequency_hz"})
    EXPECT_EQ(warm.find(name)->values, cold.find(name)->values) << name;
}

// The model's densities are those of the recording. In samples of dt white noise of density w has the
// variance w^2 / (2 dt), and differences (v[i] - v[i-1]) / dt of white v, of density d f at low frequencies,
// have d^2 / (4 pi^2 dt^3). N such differences tell their deviation to sqrt(1.5 / (2 N)). The rebalance loop,
// K = 2 pi x 36 Hz, keeps 1 / (K dt) of a sample's force noise.
TEST_F(Slow, NoiseOfTheModel) {
  const Scenario s = read(kHour);
  const recording::NoiseModel noise = s.nominal_model().noise.at("rate_dph_rthz");
  const auto values = to_recording(simulate_slow(s), s).find("rate_dph")->values;
  double mean = 0.0, square = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) square += (v - mean) * (v - mean) / static_cast<double>(values.size() - 1);
  const double expected =
      std::sqrt(0.5 * noise.white * noise.white + std::pow(noise.differenced / (2.0 * std::numbers::pi), 2));
  EXPECT_NEAR(std::sqrt(square), expected, expected * (4.0 * std::sqrt(1.5 / (2.0 * 3600.0)) + 1.0 / 226.0));
}

TEST_F(Slow, RateInIsRateOut) {
  const auto a = run("[scenario]\nduration = 60\nnoise = false\n[table]\nsteps = [[10, \"100 deg/s\"]]\n");
  const double bias_dph = a.find("rate_dph")->values[5];
  EXPECT_NEAR(a.find("rate_dph")->values[50] - bias_dph, 360000.0, 1e-6 * 360000.0);
  EXPECT_EQ(a.find("rate_in_dph")->values[50], 360000.0);
}

}  // namespace
}  // namespace hemi::scenario::testing

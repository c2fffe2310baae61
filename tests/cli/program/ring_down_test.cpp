// SPDX-License-Identifier: Apache-2.0
// Where an amplitude tells a quality factor and where it does not.
#include <cmath>
#include <numbers>
#include <string>

#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class RingDown : public ProgramTest {
 protected:
  // 2 s at 100 kS/s, 4425 Hz: amplitude exp(-t / damping_time) times 1 + `ripple` at 5 Hz. The first half
  // second is not told.
  recording::Json run(double damping_time_s, double ripple) const {
    std::string text = "adc_x,adc_y\n";
    for (int i = 0; i < 200'000; ++i) {
      const double t = i * 1e-5;
      const double amplitude = 26000.0 * std::exp(-t / damping_time_s) *
                               (1.0 + ripple * std::sin(2.0 * std::numbers::pi * 5.0 * t));
      text += std::to_string(std::lround(amplitude * std::cos(2.0 * std::numbers::pi * 4425.0 * t))) + ",0\n";
    }
    file("a.raw.csv", text);
    return good({"run", "a.raw.csv", "-f", "4425", "--adc-rate", "1e5", "--from", "0.5", "--json"}).json();
  }
};

// Q = pi f damping_time; the words' rounding, 1e-5 of the amplitude, leaves 1e-4 of it.
TEST_F(RingDown, TellsItsQualityFactor) {
  const double q = std::numbers::pi * 4425.0 * 3.0;
  EXPECT_NEAR(run(3.0, 0.0)["quality_factor"].get<double>(), q, 1e-3 * q);
}

// An amplitude that falls by 1 % and swings by as much either way is held by a loop: no ring-down.
TEST_F(RingDown, AHeldAmplitudeTellsNone) {
  const auto summary = run(150.0, 0.01);
  EXPECT_GT(summary["locked_share"].get<double>(), 0.95);
  EXPECT_FALSE(summary.contains("quality_factor")) << summary;
}

}  // namespace
}  // namespace hemi::cli::testing

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class ThermalHysteresis : public Effect {
 public:
  ThermalHysteresis(const EffectValues& values, const Instrument&, std::uint64_t) {
    double sum_degc = 0.0;
    for (std::size_t i = 0; i < kPlays; ++i) {
      // A quarter of the span at most: wider ones would not have turned round in the middle of the range.
      radius_degc_[i] = 0.25 * values.at("span") * static_cast<double>(i + 1) / static_cast<double>(kPlays);
      sum_degc += radius_degc_[i];
    }
    weight_rad_s_degc_ = values.at("loop_height") * kRadPerSecondPerDph / (2.0 * sum_degc);
  }

  void act(const Conditions& now, double, Parameters& p) override {
    const double shell_degc = now.temperatures.shell_degc;
    if (!started_) play_degc_.fill(shell_degc);
    started_ = true;
    double sum_degc = 0.0;
    for (std::size_t i = 0; i < kPlays; ++i) {
      play_degc_[i] = std::clamp(play_degc_[i], shell_degc - radius_degc_[i], shell_degc + radius_degc_[i]);
      sum_degc += play_degc_[i] - shell_degc;
    }
    p.rate_rad_s += weight_rad_s_degc_ * sum_degc;
  }

 private:
  static constexpr std::size_t kPlays = 8;
  std::array<double, kPlays> radius_degc_{};
  std::array<double, kPlays> play_degc_{};
  double weight_rad_s_degc_ = 0.0;
  bool started_ = false;
};

const Registration kEntry{
    {
        .id = "thermal_hysteresis",
        .equation = "R += w sum_i (play(T, r_i) - T), r_i = i span/32, i = 1..8, 2 w sum_i r_i = loop_height",
        .explanation = "Joints and coatings slip: the rate depends on the direction from which a temperature "
                       "was reached, not on the speed. Prandtl-Ishlinskii operators; the part proportional "
                       "to temperature is left to the calibration, so that the rate on the way down lies "
                       "above that on the way up by loop_height in the middle of a full cycle.",
        .channels = {"rate_dph"},
        .confused_with = {"thermal_gradient_bias", "frequency_ageing", "thermal_second_time_constant"},
        .separated_by = "the same cycle at three speeds: the loop stays; minor loops inside it",
        .parameters =
            {
                {"loop_height", "deg/h", 0.3, -100.0, 100.0,
                 "rate falling less rate rising in temperature, in the middle of a cycle over the full "
                 "range"},
                {"span", "degC", 60.0, 1.0, 300.0, "full range of temperature"},
            },
    },
    construct<ThermalHysteresis>};

}  // namespace
}  // namespace hemi::physics

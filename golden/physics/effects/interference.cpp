// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class Interference : public Effect {
 public:
  Interference(const EffectValues& values, const Instrument&, std::uint64_t)
      : amplitude_(values.at("amplitude")),
        omega_rad_s_(2.0 * std::numbers::pi * values.at("frequency")),
        phase_rad_(values.at("phase")),
        channel_(values.at("channel") < 0.5 ? &TelemetrySample::rate_dph : &TelemetrySample::frequency_hz) {}

  void distort(std::vector<TelemetrySample>& telemetry) override {
    for (TelemetrySample& sample : telemetry) {
      sample.*channel_ += amplitude_ * std::sin(omega_rad_s_ * sample.time_s + phase_rad_);
    }
  }

 private:
  double amplitude_;
  double omega_rad_s_;
  double phase_rad_;
  double TelemetrySample::*channel_;
};

const Registration kEntry{
    {
        .id = "interference",
        .equation = "channel += amplitude sin(2 pi frequency t + phase)",
        .explanation = "Mains, a fan or a vibration gets into a channel: a narrow line that does not move "
                       "with temperature.",
        .channels = {"rate_dph", "frequency_hz"},
        .confused_with = {"aliased_carrier"},
        .separated_by = "ramp of the temperature: the line stays",
        .parameters =
            {
                {"amplitude", "deg/h | Hz", 0.5, 0.0, 1e4, "amplitude, in the channel's unit"},
                {"frequency", "Hz", 0.1, 0.0, 1e5,
                 "frequency of the line; beyond half the telemetry rate it folds"},
                {"phase", "rad", 0.0, -6.2832, 6.2832, "phase at time 0"},
                {"channel", "1", 0.0, 0.0, 1.0, "0: rate_dph, 1: frequency_hz"},
            },
    },
    construct<Interference>};

}  // namespace
}  // namespace hemi::physics

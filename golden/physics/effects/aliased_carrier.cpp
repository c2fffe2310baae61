// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class AliasedCarrier : public Effect {
 public:
  AliasedCarrier(const EffectValues& values, const Instrument&, std::uint64_t)
      : amplitude_(values.at("amplitude")),
        start_hz_(values.at("frequency")),
        multiple_(std::round(values.at("multiple"))),
        output_rate_hz_(values.at("output_rate")),
        channel_(values.at("channel") < 0.5 ? &TelemetrySample::rate_dph : &TelemetrySample::frequency_hz) {}

  void distort(std::vector<TelemetrySample>& telemetry) override {
    if (telemetry.empty()) return;
    const double carrier_hz = telemetry.front().frequency_hz;
    const double folded_hz =
        multiple_ * carrier_hz - output_rate_hz_ * std::round(multiple_ * carrier_hz / output_rate_hz_);
    const double line_hz = start_hz_ > 0.0 ? std::copysign(start_hz_, folded_hz) : folded_hz;
    double turns = 0.0;
    double former_hz = line_hz;
    double former_s = telemetry.front().time_s;
    for (TelemetrySample& sample : telemetry) {
      const double now_hz = line_hz + multiple_ * (sample.frequency_hz - carrier_hz);
      turns += 0.5 * (former_hz + now_hz) * (sample.time_s - former_s);
      turns -= std::floor(turns);
      former_hz = now_hz;
      former_s = sample.time_s;
      sample.*channel_ += amplitude_ * std::sin(2.0 * std::numbers::pi * turns);
    }
  }

 private:
  double amplitude_;
  double start_hz_;
  double multiple_;
  double output_rate_hz_;
  double TelemetrySample::*channel_;
};

const Registration kEntry{
    {
        .id = "aliased_carrier",
        .equation = "rate += amplitude sin(2 pi int f_alias dt), f_alias = |m f - output_rate round(m "
                    "f/output_rate)|",
        .explanation =
            "What the decimation leaves of the carrier or its double folds at the output rate: 25 Hz and 50 "
            "Hz at 4425.0 Hz. The line moves with the resonator's frequency, 0.37 Hz (0.74 Hz) per degree.",
        .channels = {"rate_dph", "frequency_hz"},
        .confused_with = {"interference"},
        .separated_by = "ramp of the temperature: the line moves",
        .parameters =
            {
                {"amplitude", "deg/h | Hz", 0.5, 0.0, 1e4, "amplitude, in the channel's unit"},
                {"frequency", "Hz", 0.0, 0.0, 1e4,
                 "frequency of the line at the start; 0: as the carrier gives it"},
                {"multiple", "1", 1.0, 1.0, 8.0, "m, multiple of the carrier"},
                {"output_rate", "Hz", 200.0, 1.0, 1e5, "rate at which it folds"},
                {"channel", "1", 0.0, 0.0, 1.0, "0: rate_dph, 1: frequency_hz"},
            },
    },
    construct<AliasedCarrier>};

}  // namespace
}  // namespace hemi::physics

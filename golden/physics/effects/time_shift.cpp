// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class TimeShift : public Effect {
 public:
  TimeShift(const EffectValues& values, const Instrument&, std::uint64_t)
      : delay_s_(values.at("delay")),
        channel_(values.at("channel") < 0.5 ? &TelemetrySample::rate_dph : &TelemetrySample::frequency_hz) {}

  void distort(std::vector<TelemetrySample>& telemetry) override {
    const std::vector<TelemetrySample> original = telemetry;
    std::size_t after = 0;  // first original sample later than t - delay
    for (TelemetrySample& sample : telemetry) {
      const double at_s = sample.time_s - delay_s_;
      while (after < original.size() && original[after].time_s <= at_s) ++after;
      if (after == 0) {
        sample.*channel_ = original.front().*channel_;
      } else if (after == original.size()) {
        sample.*channel_ = original.back().*channel_;
      } else {
        const TelemetrySample& a = original[after - 1];
        const TelemetrySample& b = original[after];
        const double share = (at_s - a.time_s) / (b.time_s - a.time_s);
        sample.*channel_ = a.*channel_ + share * (b.*channel_ - a.*channel_);
      }
    }
  }

 private:
  double delay_s_;
  double TelemetrySample::*channel_;
};

const Registration kEntry{
    {
        .id = "time_shift",
        .equation = "channel(t) = channel(t - delay)",
        .explanation = "One channel arrives late, by a buffer or a filter more than the others: the lag "
                       "between frequency and rate is not the instrument's.",
        .channels = {"rate_dph", "frequency_hz"},
        .confused_with = {"pll_lag", "thermal_gradient_bias"},
        .separated_by = "fast events that both channels see (amplitude or supply step, rate step)",
        .parameters =
            {
                {"delay", "s", 2.0, 0.0, 1e4, "delay of the channel"},
                {"channel", "1", 0.0, 0.0, 1.0, "0: rate_dph, 1: frequency_hz"},
            },
    },
    construct<TimeShift>};

}  // namespace
}  // namespace hemi::physics

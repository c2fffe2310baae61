// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"
#include "golden/physics/thermal_network.hpp"

namespace hemi::physics {
namespace {

class PllLag : public Effect {
 public:
  PllLag(const EffectValues& values, const Instrument&, std::uint64_t) : loop_(values.at("time_constant")) {}

  void distort(std::vector<TelemetrySample>& telemetry) override {
    if (telemetry.empty()) return;
    double out_hz = telemetry.front().frequency_hz;
    double former_hz = out_hz;
    double former_s = telemetry.front().time_s;
    for (TelemetrySample& sample : telemetry) {
      out_hz = loop_.advance(out_hz, former_hz, sample.frequency_hz, sample.time_s - former_s);
      former_hz = sample.frequency_hz;
      former_s = sample.time_s;
      sample.frequency_hz = out_hz;
    }
  }

 private:
  Pole loop_;
};

const Registration kEntry{
    {
        .id = "pll_lag",
        .equation = "time_constant f_out' = f - f_out",
        .explanation = "The frequency is read from a slow reference-phase loop: it lags at fast changes.",
        .channels = {"frequency_hz"},
        .confused_with = {"thermal_second_time_constant", "time_shift"},
        .separated_by = "step of the frequency (amplitude with duffing, supply): a lag of the loop is the "
                        "same for all causes",
        .parameters =
            {
                {"time_constant", "s", 1.0, 1e-3, 1e3, "lag of the loop"},
            },
    },
    construct<PllLag>};

}  // namespace
}  // namespace hemi::physics

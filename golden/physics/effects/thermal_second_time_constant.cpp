// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class ThermalSecondTimeConstant : public Effect {
 public:
  ThermalSecondTimeConstant(const EffectValues& values, const Instrument&, std::uint64_t)
      : tau_s_(values.at("second_time_constant")) {}

  void heat(const Conditions&, double, Instrument& instrument, double&) override {
    instrument.stem_time_constant_s = tau_s_;
  }

 private:
  double tau_s_;
};

const Registration kEntry{
    {
        .id = "thermal_second_time_constant",
        .equation = "tau_stem T_stem' = T_case - T_stem, tau_shell T_shell' = T_stem - T_shell",
        .explanation =
            "The shell hangs on a stem that has to follow the case first: two poles in a chain where the "
            "nominal model has one. A step of the case shows no kink in the frequency but an S.",
        .channels = {"frequency_hz"},
        .confused_with = {"thermal_hysteresis", "frequency_ageing", "self_heating"},
        .separated_by = "two ramp rates and a hold: the second pole scales with the rate of change and is "
                        "over a few of its time constants after it",
        .parameters =
            {
                {"second_time_constant", "s", 300.0, 1.0, 2e4,
                 "time constant of the stem between case and shell"},
            },
    },
    construct<ThermalSecondTimeConstant>};

}  // namespace
}  // namespace hemi::physics

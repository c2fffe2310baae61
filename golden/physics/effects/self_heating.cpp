// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"
#include "golden/physics/thermal_network.hpp"

namespace hemi::physics {
namespace {

class SelfHeating : public Effect {
 public:
  SelfHeating(const EffectValues& values, const Instrument&, std::uint64_t)
      : rise_(values.at("rise"), values.at("time_constant")) {}

  void heat(const Conditions& now, double, Instrument&, double& heat_degc) override {
    const Environment& at = now.environment;
    if (!started_) {
      rise_.start(at.time_s, at.power_on_s);
    } else {
      rise_.advance(at.time_s, at.power_on_s);
    }
    started_ = true;
    heat_degc += rise_.value_degc();
  }

 private:
  PowerOnRise rise_;
  bool started_ = false;
};

const Registration kEntry{
    {
        .id = "self_heating",
        .equation = "T_shell += rise (1 - exp(-(t - t_on)/time_constant))",
        .explanation = "The electronics heat the resonator from the moment of power-on; the case thermometer "
                       "does not see it.",
        .channels = {"frequency_hz"},
        .confused_with = {"frequency_ageing", "duffing", "thermal_second_time_constant"},
        .separated_by = "power cycle: it starts anew",
        .parameters =
            {
                {"rise", "degC", 1.0, -20.0, 50.0, "settled rise of the shell over what the case explains"},
                {"time_constant", "s", 1500.0, 1.0, 1e5, "time constant of the rise"},
            },
    },
    construct<SelfHeating>};

}  // namespace
}  // namespace hemi::physics

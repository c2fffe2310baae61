// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class FrequencyAgeing : public Effect {
 public:
  FrequencyAgeing(const EffectValues& values, const Instrument&, std::uint64_t)
      : law_(std::lround(values.at("law"))), t0_s_(values.at("time_constant")) {
    scale_rad_s_ = 2.0 * std::numbers::pi * values.at("total") / growth(values.at("duration"));
  }

  void act(const Conditions&, double dt_s, Parameters& p) override {
    elapsed_s_ += dt_s;
    p.omega_rad_s += scale_rad_s_ * growth(elapsed_s_);
  }

 private:
  double growth(double t_s) const {
    if (law_ == 0) return std::log1p(t_s / t0_s_);
    return law_ == 1 ? -std::expm1(-t_s / t0_s_) : t_s;
  }

  long law_;
  double t0_s_;
  double scale_rad_s_;
  double elapsed_s_ = 0.0;
};

const Registration kEntry{
    {
        .id = "frequency_ageing",
        .equation = "f += total g(t)/g(duration); g = ln(1 + t/t0) | 1 - exp(-t/t0) | t",
        .explanation = "Stress in the shell and its metal coating relaxes: at equal temperature the "
                       "frequency moves one way, quickly at first.",
        .channels = {"frequency_hz"},
        .confused_with = {"thermal_hysteresis", "oscillator_ageing", "self_heating"},
        .separated_by =
            "repeated soaks at the same temperature; from oscillator_ageing only a second clock separates it",
        .parameters =
            {
                {"total", "Hz", 1e-3, -10.0, 10.0, "change over the recording"},
                {"duration", "s", 18000.0, 1.0, 1e9, "length of the recording"},
                {"time_constant", "s", 3600.0, 1.0, 1e9, "t0 of the logarithm or exponential"},
                {"law", "1", 0.0, 0.0, 2.0, "0: logarithm, 1: exponential, 2: linear"},
            },
    },
    construct<FrequencyAgeing>};

}  // namespace
}  // namespace hemi::physics

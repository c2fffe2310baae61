// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class FrequencyPolynomialOrder : public Effect {
 public:
  FrequencyPolynomialOrder(const EffectValues& values, const Instrument&, std::uint64_t)
      : a4_(values.at("a4")), a5_(values.at("a5")), reference_degc_(values.at("reference")) {}

  void act(const Conditions& now, double, Parameters& p) override {
    const double t = now.temperatures.shell_degc - reference_degc_;
    p.omega_rad_s += 2.0 * std::numbers::pi * (a4_ + a5_ * t) * t * t * t * t;
  }

 private:
  double a4_;
  double a5_;
  double reference_degc_;
};

const Registration kEntry{
    {
        .id = "frequency_polynomial_order",
        .equation = "f += a4 (T - T0)^4 + a5 (T - T0)^5",
        .explanation = "The cubic of the nominal model is not enough: the elastic constants of the shell "
                       "curve further. The same in both directions and at every speed.",
        .channels = {"frequency_hz"},
        .confused_with = {"oscillator_temperature"},
        .separated_by = "case and resonator at different temperatures: this one follows the shell, the "
                        "oscillator its board",
        .parameters =
            {
                {"a4", "Hz/degC^4", 4e-9, -1e-5, 1e-5, "coefficient of the fourth power"},
                {"a5", "Hz/degC^5", 0.0, -1e-7, 1e-7, "coefficient of the fifth power"},
                {"reference", "degC", 0.0, -100.0, 150.0, "T0"},
            },
    },
    construct<FrequencyPolynomialOrder>};

}  // namespace
}  // namespace hemi::physics

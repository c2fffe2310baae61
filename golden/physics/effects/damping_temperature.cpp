// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class DampingTemperature : public Effect {
 public:
  DampingTemperature(const EffectValues& values, const Instrument&, std::uint64_t)
      : peak_(values.at("peak")), centre_degc_(values.at("centre")), width_degc_(values.at("width")) {}

  void act(const Conditions& now, double, Parameters& p) override {
    p.damping_per_s *= 1.0 + peak_ / std::cosh((now.temperatures.shell_degc - centre_degc_) / width_degc_);
  }

 private:
  double peak_;
  double centre_degc_;
  double width_degc_;
};

const Registration kEntry{
    {
        .id = "damping_temperature",
        .equation = "1/tau(T) *= 1 + peak / cosh((T - centre)/width)",
        .explanation = "A relaxation (thermoelastic, or a loss peak of the glass) passes the vibration's "
                       "period at one temperature: a Debye peak, 2 w tr/(1 + (w tr)^2) with ln(w tr) = (T - "
                       "centre)/width, stands on the nominal polynomial.",
        .channels = {"drive_v"},
        .confused_with = {"gas_leak", "pickoff_gain"},
        .separated_by = "return to the same temperature: the drive comes back",
        .parameters =
            {
                {"peak", "1", 0.05, -0.9, 10.0, "largest relative deviation from the nominal polynomial"},
                {"centre", "degC", 10.0, -200.0, 200.0, "temperature of the peak"},
                {"width", "degC", 12.0, 0.5, 200.0,
                 "temperature over which the relaxation time changes e times"},
            },
    },
    construct<DampingTemperature>};

}  // namespace
}  // namespace hemi::physics

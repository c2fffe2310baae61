// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class ElectrostaticSoftening : public Effect {
 public:
  ElectrostaticSoftening(const EffectValues& values, const Instrument&, std::uint64_t)
      : shift_(values.at("relative_shift")),
        nominal_v_(values.at("nominal_supply")),
        scale_shift_(values.at("scale_shift")) {}

  void act(const Conditions& now, double, Parameters& p) override {
    const double v = now.environment.supply_v / nominal_v_;
    const double gain = 1.0 + scale_shift_ * (v - 1.0);
    p.omega_rad_s *= 1.0 + shift_ * (v * v - 1.0);
    p.rebalance_per_s *= gain;
    p.drive_per_s *= gain;
  }

 private:
  double shift_;
  double nominal_v_;
  double scale_shift_;
};

const Registration kEntry{
    {
        .id = "electrostatic_softening",
        .equation = "f *= 1 + relative_shift ((V/V0)^2 - 1); rebalance gain *= 1 + scale_shift (V/V0 - 1)",
        .explanation = "The bias of the electrodes is a negative spring, df/f = -(1/2) ke/k with ke ~ V^2: 1 "
                       "ppm for 1 % of V at the typical size. Where the same bias feeds the forcers, their "
                       "gain follows V, and with it drive and scale factor.",
        .channels = {"frequency_hz", "rate_dph", "drive_v"},
        .confused_with = {"frequency_polynomial_order", "oscillator_temperature"},
        .separated_by = "step of the supply at constant temperature",
        .parameters =
            {
                {"relative_shift", "1", -5e-5, -1e-2, 1e-2, "df/f per 100 % of V^2"},
                {"nominal_supply", "V", 5.0, 0.1, 1e4, "V0"},
                {"scale_shift", "1", 0.0, -2.0, 2.0, "relative change of the forcers' gain per 100 % of V"},
            },
    },
    construct<ElectrostaticSoftening>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class ScaleFactorTemperature : public Effect {
 public:
  ScaleFactorTemperature(const EffectValues& values, const Instrument&, std::uint64_t)
      : per_degc_(values.at("per_degc")) {}

  void act(const Conditions& now, double, Parameters& p) override {
    const double change = per_degc_ * (now.temperatures.shell_degc - kReferenceDegc);
    p.rate_rad_s += change * now.environment.rate_dph * kRadPerSecondPerDph;
    p.rate_slope_rad_s2 += change * now.environment.rate_slope_dph_s * kRadPerSecondPerDph;
  }

 private:
  static constexpr double kReferenceDegc = 20.0;
  double per_degc_;
};

const Registration kEntry{
    {
        .id = "scale_factor_temperature",
        .equation = "R = W (1 + per_degc (T - 20 degC)) + B",
        .explanation = "The angular gain or the forcers change with temperature; seen only while turning.",
        .channels = {"rate_dph"},
        .confused_with = {"pickoff_gain", "scale_factor_nonlinearity"},
        .separated_by = "+ and - rate at two temperatures",
        .parameters =
            {
                {"per_degc", "1/degC", 5e-5, -0.01, 0.01,
                 "relative change of the scale factor per degree of the shell"},
            },
    },
    construct<ScaleFactorTemperature>};

}  // namespace
}  // namespace hemi::physics

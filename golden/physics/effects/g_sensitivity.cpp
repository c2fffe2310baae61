// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class GSensitivity : public Effect {
 public:
  GSensitivity(const EffectValues& values, const Instrument&, std::uint64_t)
      : per_g_(values.at("per_g") * kRadPerSecondPerDph),
        per_g2_(values.at("per_g2") * kRadPerSecondPerDph) {}

  void act(const Conditions& now, double, Parameters& p) override {
    const double a = now.environment.accel_g;
    p.rate_rad_s += (per_g_ + per_g2_ * a) * a;
  }

 private:
  double per_g_;
  double per_g2_;
};

const Registration kEntry{
    {
        .id = "g_sensitivity",
        .equation = "R += per_g a + per_g2 a^2",
        .explanation = "Acceleration bends the stem and shifts the shell in its electrodes.",
        .channels = {"rate_dph"},
        .confused_with = {"earth_rate"},
        .separated_by = "tumble: +1 g, 0, -1 g along the axis",
        .parameters =
            {
                {"per_g", "deg/h/g", 0.1, -100.0, 100.0, "linear coefficient"},
                {"per_g2", "deg/h/g^2", 0.0, -100.0, 100.0, "quadratic coefficient"},
            },
    },
    construct<GSensitivity>};

}  // namespace
}  // namespace hemi::physics

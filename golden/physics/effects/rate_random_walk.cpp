// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"
#include "golden/physics/noise.hpp"

namespace hemi::physics {
namespace {

class RateRandomWalk : public Effect {
 public:
  RateRandomWalk(const EffectValues& values, const Instrument&, std::uint64_t seed)
      : walk_(values.at("density") * kRadPerSecondPerDph, seed) {}

  void act(const Conditions&, double dt_s, Parameters& p) override { p.rate_rad_s += walk_.advance(dt_s); }

 private:
  RandomWalk walk_;
};

const Registration kEntry{
    {
        .id = "rate_random_walk",
        .equation = "R += density W(t), W the Wiener process",
        .explanation = "The rate wanders without cause: ramp of slope +1/2 in the Allan deviation.",
        .channels = {"rate_dph"},
        .confused_with = {"rate_flicker", "frequency_ageing"},
        .separated_by = "long hold, and a stochastic test: increments are white",
        .parameters =
            {
                {"density", "deg/h/sqrt(s)", 1e-3, 0.0, 10.0, "walk per root second"},
            },
    },
    construct<RateRandomWalk>};

}  // namespace
}  // namespace hemi::physics

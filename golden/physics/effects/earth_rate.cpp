// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class EarthRate : public Effect {
 public:
  EarthRate(const EffectValues& values, const Instrument&, std::uint64_t)
      : rate_rad_s_(15.041 * kRadPerSecondPerDph *
                    std::sin((values.at("latitude") + values.at("tilt")) * std::numbers::pi / 180.0)) {}

  void act(const Conditions&, double, Parameters& p) override { p.rate_rad_s += rate_rad_s_; }

 private:
  double rate_rad_s_;
};

const Registration kEntry{
    {
        .id = "earth_rate",
        .equation = "R += 15.041 deg/h sin(latitude + tilt)",
        .explanation =
            "The Earth turns, and the sensing axis sees its part: a constant that changes with the attitude.",
        .channels = {"rate_dph"},
        .confused_with = {"g_sensitivity"},
        .separated_by = "flip: the axis turned over changes the sign",
        .parameters =
            {
                {"latitude", "deg", 45.0, -90.0, 90.0, "geographic latitude of an axis that points up"},
                {"tilt", "deg", 0.0, -180.0, 180.0, "tilt of the axis towards the pole"},
            },
    },
    construct<EarthRate>};

}  // namespace
}  // namespace hemi::physics

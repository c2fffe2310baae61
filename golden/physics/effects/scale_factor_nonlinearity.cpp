// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class ScaleFactorNonlinearity : public Effect {
 public:
  ScaleFactorNonlinearity(const EffectValues& values, const Instrument&, std::uint64_t)
      : cubic_dph_(values.at("cubic")), quadratic_dph_(values.at("quadratic")) {}

  void act(const Conditions& now, double, Parameters& p) override {
    const double w = now.environment.rate_dph / kReferenceDph;
    p.rate_rad_s += (quadratic_dph_ + cubic_dph_ * w) * w * w * kRadPerSecondPerDph;
    p.rate_slope_rad_s2 += (2.0 * quadratic_dph_ + 3.0 * cubic_dph_ * w) * w *
                           now.environment.rate_slope_dph_s / kReferenceDph * kRadPerSecondPerDph;
  }

 private:
  static constexpr double kReferenceDph = 1e5;
  double cubic_dph_;
  double quadratic_dph_;
};

const Registration kEntry{
    {
        .id = "scale_factor_nonlinearity",
        .equation = "R = W + quadratic (W/1e5 deg/h)^2 + cubic (W/1e5 deg/h)^3",
        .explanation = "The rebalance force is not proportional to its command.",
        .channels = {"rate_dph"},
        .confused_with = {"scale_factor_temperature"},
        .separated_by = "rate sweep at constant temperature",
        .parameters =
            {
                {"cubic", "deg/h", 1.0, -1e4, 1e4, "deviation at 1e5 deg/h that is odd in the rate"},
                {"quadratic", "deg/h", 0.0, -1e4, 1e4, "deviation at 1e5 deg/h that is even"},
            },
    },
    construct<ScaleFactorNonlinearity>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

constexpr double kNominalSupply_v = 5.0;

class SupplyRate : public Effect {
 public:
  SupplyRate(const EffectValues& values, const Instrument&, std::uint64_t)
      : per_v_(values.at("per_v") * kRadPerSecondPerDph) {}

  void act(const Conditions& now, double, Parameters& p) override {
    p.rate_rad_s += per_v_ * (now.environment.supply_v - kNominalSupply_v);
  }

 private:
  double per_v_;  ///< rad/s/V
};

const Registration kEntry{
    {
        .id = "supply_rate",
        .equation = "R += per_v (supply - 5 V)",
        .explanation =
            "The reference of the rebalance converter follows the supply a little: the rate moves with it.",
        .channels = {"rate_dph"},
        .confused_with = {"g_sensitivity"},
        .separated_by = "supply steps at constant temperature: the rate steps with them, at once",
        .parameters = {{"per_v", "deg/h/V", 0.5, -100.0, 100.0, "rate by a volt too much"}},
    },
    construct<SupplyRate>};

}  // namespace
}  // namespace hemi::physics

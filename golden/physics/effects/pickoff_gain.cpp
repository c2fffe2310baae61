// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class PickoffGain : public Effect {
 public:
  PickoffGain(const EffectValues& values, const Instrument&, std::uint64_t)
      : per_degc_(values.at("per_degc")) {}

  void act(const Conditions& now, double, Parameters& p) override {
    p.pickoff_gain_x *= 1.0 + per_degc_ * (now.temperatures.board_degc - kReferenceDegc);
  }

 private:
  static constexpr double kReferenceDegc = 28.0;
  double per_degc_;
};

const Registration kEntry{
    {
        .id = "pickoff_gain",
        .equation = "measured = (1 + e) true, e = per_degc (T_board - 28 degC): A = 1/(1 + e), drive and "
                    "rate follow A",
        .explanation = "The gain of the primary pickoff drifts with the board. The amplitude loop holds what "
                       "it measures, so that the true amplitude moves the other way, and with it the drive "
                       "and the scale factor.",
        .channels = {"drive_v", "rate_dph"},
        .confused_with = {"damping_temperature", "scale_factor_temperature"},
        .separated_by = "scale factor by rate input while the board's temperature changes",
        .parameters =
            {
                {"per_degc", "1/degC", 1e-4, -0.01, 0.01, "relative gain per degree of the board"},
            },
    },
    construct<PickoffGain>};

}  // namespace
}  // namespace hemi::physics

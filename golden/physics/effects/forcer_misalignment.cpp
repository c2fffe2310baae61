// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class ForcerMisalignment : public Effect {
 public:
  ForcerMisalignment(const EffectValues& values, const Instrument& instrument, std::uint64_t)
      : gain_rad_s_(values.at("gain") * kRadPerSecondPerDph * instrument.drive_full_scale_v),
        full_scale_rad_s_(instrument.rebalance_full_scale_dps * 3600.0 * kRadPerSecondPerDph) {}

  void act(const Conditions&, double, Parameters& p) override {
    // A force that acts along +y is rebalanced like a negative rate.
    p.forcer_misalignment_rad -= gain_rad_s_ * p.rebalance_per_s / (full_scale_rad_s_ * p.drive_per_s);
  }

 private:
  double gain_rad_s_;  ///< for a full-scale drive
  double full_scale_rad_s_;
};

const Registration kEntry{
    {
        .id = "forcer_misalignment",
        .equation =
            "R -= alpha D/kappa, D = A/tau the drive's growth: R += gain drive_v; 0.52 deg/h for 1 mrad",
        .explanation = "The drive electrodes sit at a small angle: part of the drive's force acts on the "
                       "secondary mode, where the rebalance loop takes it for a rate.",
        .channels = {"rate_dph"},
        .confused_with = {"damping_anisotropy"},
        .separated_by = "exchange of the two modes; an amplitude step, during which the drive is not A/tau",
        .parameters =
            {
                {"gain", "deg/h/V", 20.0, -1e5, 1e5, "rate for each volt of drive"},
            },
    },
    construct<ForcerMisalignment>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class DampingAnisotropy : public Effect {
 public:
  DampingAnisotropy(const EffectValues& values, const Instrument& instrument, std::uint64_t)
      : gain_rad_s_(values.at("gain") * kRadPerSecondPerDph * instrument.drive_full_scale_v) {}

  void act(const Conditions&, double, Parameters& p) override {
    p.mismatch_sin_per_s +=
        2.0 * p.kappa * gain_rad_s_ * (p.damping_per_s + 0.5 * p.mismatch_cos_per_s) / p.drive_per_s;
  }

 private:
  double gain_rad_s_;  ///< for a full-scale drive
};

const Registration kEntry{
    {
        .id = "damping_anisotropy",
        .equation = "R += d sin 2th_tau/(2 kappa), d proportional to 1/tau: R += gain drive_v",
        .explanation = "Damping depends on the direction in the shell: the vibration drifts towards the "
                       "weaker damping, and the rebalance loop reports that as a rate, proportional to the "
                       "damping and so to the drive. At quality factor 1e7, 1 % makes 2.6 deg/h.",
        .channels = {"rate_dph"},
        .confused_with = {"forcer_misalignment", "gas_leak"},
        .separated_by = "exchange of the two modes: at rest it is identical to forcer_misalignment",
        .parameters =
            {
                {"gain", "deg/h/V", 100.0, -1e5, 1e5, "rate for each volt of drive"},
            },
    },
    construct<DampingAnisotropy>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class DriveFeedthrough : public Effect {
 public:
  DriveFeedthrough(const EffectValues& values, const Instrument&, std::uint64_t)
      : coupling_(values.at("coupling")) {}

  void act(const Conditions&, double, Parameters& p) override { p.drive_feedthrough += coupling_; }

 private:
  double coupling_;
};

const Registration kEntry{
    {
        .id = "drive_feedthrough",
        .equation = "P += c V_drive: phase of the drive pulled by phi, df/f = tan(phi)/(2 Q)",
        .explanation = "The drive couples into the primary pickoff through the wiring. It stands 90 degrees "
                       "from the vibration, so that the reference phase is off by phi, and the resonator is "
                       "driven beside its resonance.",
        .channels = {"adc_x", "frequency_hz", "drive_v"},
        .confused_with = {"forcer_misalignment", "duffing"},
        .separated_by = "gating the drive: the line is gone while the vibration rings on",
        .parameters =
            {
                {"coupling", "1", 0.05, -2.0, 2.0, "pickoff, in ADC full scales, for a full-scale drive"},
            },
    },
    construct<DriveFeedthrough>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class AdcOffset : public Effect {
 public:
  AdcOffset(const EffectValues& values, const Instrument&, std::uint64_t)
      : offset_lsb_{values.at("x"), values.at("y")} {}

  void act(const Conditions&, double, Parameters& p) override {
    p.adc_offset_lsb[0] += offset_lsb_[0];
    p.adc_offset_lsb[1] += offset_lsb_[1];
  }

 private:
  std::array<double, 2> offset_lsb_;
};

const Registration kEntry{
    {
        .id = "adc_offset",
        .equation = "v += offset",
        .explanation =
            "A constant in the raw samples. The demodulator turns it into a line at the resonator's "
            "frequency, which the decimation filter removes: nothing of it is left in the telemetry.",
        .channels = {"adc_x", "adc_y"},
        .confused_with = {"quadratic_stiffness", "pickoff_nonlinearity"},
        .separated_by = "histogram of the raw samples; the mean does not follow the amplitude",
        .parameters =
            {
                {"x", "LSB", 20.0, -3000.0, 3000.0, "offset of the primary channel, LSB of 16 bit"},
                {"y", "LSB", 20.0, -3000.0, 3000.0, "offset of the secondary channel"},
            },
    },
    construct<AdcOffset>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class AdcSaturation : public Effect {
 public:
  AdcSaturation(const EffectValues& values, const Instrument&, std::uint64_t) : level_(values.at("level")) {}

  void act(const Conditions&, double, Parameters& p) override { p.adc_clip = std::min(p.adc_clip, level_); }

 private:
  double level_;
};

const Registration kEntry{
    {
        .id = "adc_saturation",
        .equation = "v = clip(v, level): fundamental a (2/pi) (asin u + u sqrt(1 - u^2)), u = level/a",
        .explanation = "The front end clips below the ADC's full scale: flat tops and odd harmonics; the "
                       "amplitude loop holds the fundamental of the clipped wave, so that the true amplitude "
                       "is too large and drive and scale factor with it.",
        .channels = {"adc_x", "adc_y", "drive_v", "rate_dph"},
        .confused_with = {"pickoff_nonlinearity", "adc_nonlinearity"},
        .separated_by = "histogram of the raw samples: empty beyond the level",
        .parameters =
            {
                {"level", "1", 0.78, 0.72, 1.0,
                 "clipping level, fraction of full scale (nominal amplitude 0.8)"},
            },
    },
    construct<AdcSaturation>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class AdcNonlinearity : public Effect {
 public:
  AdcNonlinearity(const EffectValues& values, const Instrument&, std::uint64_t)
      : peak_lsb_(values.at("peak")) {}

  void act(const Conditions&, double, Parameters& p) override { p.adc_inl_lsb += peak_lsb_; }

 private:
  double peak_lsb_;
};

const Registration kEntry{
    {
        .id = "adc_nonlinearity",
        .equation = "v += INL(v), |INL| <= peak",
        .explanation = "The converter's steps are not equal: wrong weights of the upper bits make harmonics "
                       "at fixed codes, whatever the vibration; the fundamental changes by parts in 1e5, and "
                       "the amplitude loop follows.",
        .channels = {"adc_x", "adc_y", "drive_v", "rate_dph"},
        .confused_with = {"pickoff_nonlinearity", "adc_saturation"},
        .separated_by =
            "histogram of the raw samples: the pattern stays at its codes when the amplitude changes",
        .parameters =
            {
                {"peak", "LSB", 2.0, -100.0, 100.0, "peak of the integral non-linearity, LSB of 16 bit"},
            },
    },
    construct<AdcNonlinearity>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class FrequencySplit : public Effect {
 public:
  FrequencySplit(const EffectValues& values, const Instrument& instrument, std::uint64_t)
      : span_(values.at("span") / instrument.quadrature_full_scale_v),
        per_s_(values.at("per_hour") / 3600.0 / instrument.quadrature_full_scale_v),
        middle_degc_(0.5 * (values.at("temperature_low") + values.at("temperature_high"))),
        half_degc_(0.5 * (values.at("temperature_high") - values.at("temperature_low"))) {
    if (half_degc_ <= 0.0) {
      throw std::invalid_argument("effect frequency_split: temperature_low must lie below temperature_high");
    }
  }

  void act(const Conditions& now, double dt_s, Parameters& p) override {
    elapsed_s_ += dt_s;
    const double u = (now.temperatures.shell_degc - middle_degc_) / half_degc_;
    p.split_sin_rad_s += p.quadrature_span_rad_s * (span_ * u * u + per_s_ * elapsed_s_);
  }

 private:
  double span_;  ///< fractions of full scale
  double per_s_;
  double middle_degc_;
  double half_degc_;
  double elapsed_s_ = 0.0;
};

const Registration kEntry{
    {
        .id = "frequency_split",
        .equation = "dw sin 2th_w += (span ((T - Tm)/Th)^2 + per_hour t) span of 1 V",
        .explanation = "The stiffness axes and the split of the two frequencies change with temperature "
                       "beyond the nominal polynomial (or with time): the quadrature loop has to cancel "
                       "more. 1 mHz makes 0.2 V of command.",
        .channels = {"quadrature_v"},
        .confused_with = {"pickoff_gain"},
        .separated_by = "drive angle: turning the vibration by 45 degrees moves the split into the frequency",
        .parameters =
            {
                {"span", "V", 0.1, -10.0, 10.0,
                 "peak to peak of the deviation over the range of temperature"},
                {"temperature_low", "degC", -20.0, -200.0, 200.0, "lower end of the range"},
                {"temperature_high", "degC", 40.0, -200.0, 200.0, "upper end of the range"},
                {"per_hour", "V/h", 0.0, -1.0, 1.0, "drift in time"},
            },
    },
    construct<FrequencySplit>};

}  // namespace
}  // namespace hemi::physics

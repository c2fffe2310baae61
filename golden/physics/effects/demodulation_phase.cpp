// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class DemodulationPhase : public Effect {
 public:
  DemodulationPhase(const EffectValues& values, const Instrument& instrument, std::uint64_t)
      : gain_rad_s_(values.at("gain") * kRadPerSecondPerDph * instrument.quadrature_full_scale_v),
        per_degc_(values.at("per_degc")) {}

  void act(const Conditions& now, double, Parameters& p) override {
    const double full_scale_rad_s = p.quadrature_span_rad_s / (2.0 * p.kappa);
    const double tangent =
        gain_rad_s_ / full_scale_rad_s * (1.0 + per_degc_ * (now.temperatures.board_degc - kReferenceDegc));
    // The cancelled quadrature leaks through the phase of its forcing, what is left of it through the
    // demodulation.
    p.rate_rad_s += tangent * p.split_sin_rad_s / (2.0 * p.kappa);
    p.pickoff_phase_y_rad += std::atan(tangent);
  }

 private:
  static constexpr double kReferenceDegc = 28.0;
  double gain_rad_s_;  ///< for a full-scale quadrature command
  double per_degc_;
};

const Registration kEntry{
    {
        .id = "demodulation_phase",
        .equation = "R += tan(phi) Q, tan(phi) = gain (1 + per_degc (T_board - 28 degC)) / (rate of 1 V of "
                    "quadrature)",
        .explanation =
            "Demodulation and forcing of the secondary are turned by a small phase: part of the quadrature, "
            "of its forcing and of what an offset of its command leaves over, is taken for a rate. 1 mrad "
            "makes 1.2 deg/h for each mHz of split, that is 5.8 deg/h/V at 5 mHz/V.",
        .channels = {"rate_dph"},
        .confused_with = {"thermal_gradient_bias", "frequency_split"},
        .separated_by = "step of the quadrature (quadrature_trim_v): the rate follows at once",
        .parameters =
            {
                {"gain", "deg/h/V", 5.0, -500.0, 500.0, "rate for each volt of quadrature"},
                {"per_degc", "1/degC", 0.0, -0.1, 0.1,
                 "relative change of the phase with the board's temperature"},
            },
    },
    construct<DemodulationPhase>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class PickoffNonlinearity : public Effect {
 public:
  PickoffNonlinearity(const EffectValues& values, const Instrument&, std::uint64_t)
      : quadratic_(values.at("a2") * values.at("gap_ratio")),
        cubic_(values.at("a3") * values.at("gap_ratio") * values.at("gap_ratio")) {}

  void act(const Conditions&, double, Parameters& p) override {
    p.pickoff_quadratic += quadratic_;
    p.pickoff_cubic += cubic_;
  }

 private:
  double quadratic_;
  double cubic_;
};

const Registration kEntry{
    {
        .id = "pickoff_nonlinearity",
        .equation = "v = g x (1 + a2 x/d + a3 (x/d)^2): fundamental g A (1 + (3/4) a3 (A/d)^2)",
        .explanation = "The capacitance of a pickoff is not linear in the gap: second and third harmonic in "
                       "the raw samples; the fundamental, which the amplitude loop holds, grows by the cubic "
                       "part, so that the true amplitude is a little smaller.",
        .channels = {"adc_x", "adc_y", "drive_v", "rate_dph"},
        .confused_with = {"adc_nonlinearity", "duffing"},
        .separated_by = "amplitude sweep: harmonics grow with the second and third power",
        .parameters =
            {
                {"a2", "1", 1.0, -10.0, 10.0, "quadratic coefficient"},
                {"a3", "1", 1.0, -10.0, 10.0, "cubic coefficient"},
                {"gap_ratio", "1", 0.01, 0.0, 0.1, "nominal amplitude over the gap d"},
            },
    },
    construct<PickoffNonlinearity>};

}  // namespace
}  // namespace hemi::physics

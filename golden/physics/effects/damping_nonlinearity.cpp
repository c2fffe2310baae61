// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class DampingNonlinearity : public Effect {
 public:
  DampingNonlinearity(const EffectValues& values, const Instrument&, std::uint64_t)
      : relative_(values.at("relative")), quadratic_(values.at("quadratic")) {}

  void act(const Conditions&, double, Parameters& p) override {
    p.cubic_damping_per_s += relative_ * p.damping_per_s;
    p.quadratic_damping += quadratic_;
  }

 private:
  double relative_;
  double quadratic_;
};

const Registration kEntry{
    {
        .id = "damping_nonlinearity",
        .equation = "1/tau = (1/tau0) (1 + quadratic A + relative A^2)",
        .explanation = "Damping grows with the speed of the vibration: forces like c2 v |v| (gas, friction) "
                       "and c3 v^3. The drive grows faster than the amplitude.",
        .channels = {"drive_v"},
        .confused_with = {"duffing", "damping_temperature"},
        .separated_by =
            "phase: it is in quadrature to a stiffness; amplitude steps move the drive and not the frequency",
        .parameters =
            {
                {"relative", "1", 0.01, -0.9, 10.0, "relative change of drive per unit of A^2"},
                {"quadratic", "1", 0.0, -0.9, 10.0, "relative change of drive per unit of A"},
            },
    },
    construct<DampingNonlinearity>};

}  // namespace
}  // namespace hemi::physics

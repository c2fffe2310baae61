// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class QuadraticStiffness : public Effect {
 public:
  QuadraticStiffness(const EffectValues& values, const Instrument&, std::uint64_t)
      : k2_per_s2_(values.at("k2") * values.at("volts_per_amplitude")) {}

  void act(const Conditions&, double, Parameters& p) override {
    p.quadratic_stiffness += k2_per_s2_ / (p.omega_rad_s * p.omega_rad_s);
  }

 private:
  double k2_per_s2_;
};

const Registration kEntry{
    {
        .id = "quadratic_stiffness",
        .equation = "x'' + ... + w^2 x + k2 x^2 = f: mean -(k2/w^2) a^2/2, second harmonic (k2/w^2) a^2/6, "
                    "df/f = -(5/12) (k2/w^2)^2 a^2",
        .explanation = "The spring is not symmetric: the vibration has a mean and even harmonics; the "
                       "frequency falls with the square of the coefficient only.",
        .channels = {"adc_x", "frequency_hz"},
        .confused_with = {"pickoff_nonlinearity", "duffing"},
        .separated_by =
            "amplitude: a constant force shifts the mean at every amplitude alike, this one with its square",
        .parameters =
            {
                {"k2", "1/(V s^2)", 1e6, -1e8, 1e8, "quadratic stiffness for a displacement in V"},
                {"volts_per_amplitude", "V", 1.0, 1e-6, 1e3, "displacement at nominal amplitude"},
            },
    },
    construct<QuadraticStiffness>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class Duffing : public Effect {
 public:
  Duffing(const EffectValues& values, const Instrument&, std::uint64_t)
      : relative_((8.0 / 3.0) * values.at("relative_shift")),
        k3_per_s2_(values.at("k3") * values.at("volts_per_amplitude") * values.at("volts_per_amplitude")) {}

  void act(const Conditions&, double, Parameters& p) override {
    p.cubic_stiffness += relative_ + k3_per_s2_ / (p.omega_rad_s * p.omega_rad_s);
  }

 private:
  double relative_;
  double k3_per_s2_;
};

const Registration kEntry{
    {
        .id = "duffing",
        .equation = "x'' + ... + w^2 x + k3 x^3 = f: df/f = (3/8) (k3/w^2) a^2 = relative_shift A^2",
        .explanation =
            "The shell gets stiffer (or softer) with amplitude: the frequency follows the amplitude at once, "
            "the resonance of a bench sweep bends, and the third harmonic appears in the pickoff.",
        .channels = {"frequency_hz", "adc_x"},
        .confused_with = {"self_heating", "drive_feedthrough"},
        .separated_by = "amplitude step: instant against slow",
        .parameters =
            {
                {"relative_shift", "1", 1e-7, -1e-2, 1e-2, "df/f from amplitude 0 to nominal"},
                {"k3", "1/(V^2 s^2)", 0.0, -1e9, 1e9, "cubic stiffness of a bench, for a displacement in V"},
                {"volts_per_amplitude", "V", 1.0, 1e-6, 1e3, "displacement at nominal amplitude, for k3"},
            },
    },
    construct<Duffing>};

}  // namespace
}  // namespace hemi::physics

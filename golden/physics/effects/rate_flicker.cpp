// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <stdexcept>

#include "golden/physics/effect.hpp"
#include "golden/physics/noise.hpp"

namespace hemi::physics {
namespace {

class RateFlicker : public Effect {
 public:
  RateFlicker(const EffectValues& values, const Instrument&, std::uint64_t seed)
      : noise_(level(values), 1.0 / values.at("duration"), values.at("highest_frequency") / kBeyond, seed) {}

  void act(const Conditions&, double dt_s, Parameters& p) override {
    p.rate_rad_s += kRadPerSecondPerDph * noise_.advance(dt_s);
  }

 private:
  // FlickerNoise has poles up to one and a half decades beyond the end that it is given, a quarter of a
  // decade (half their distance) short of where a sharp end would hold the same variance.
  static constexpr double kBeyond = 31.622776601683793;
  static constexpr double kHalfDistance = 1.7782794100389228;

  static double level(const EffectValues& values) {
    const double span = values.at("duration") * values.at("highest_frequency");
    if (span <= 2.0 * kBeyond) {
      throw std::invalid_argument("effect rate_flicker: duration times highest_frequency must exceed 63");
    }
    constexpr double kMeanRemoved = 0.915093;  // ln(2 pi) + Euler's constant - 3/2
    const double density_dph = values.at("density");
    return density_dph * density_dph / (std::log(kHalfDistance * span) + kMeanRemoved);
  }

  FlickerNoise noise_;
};

const Registration kEntry{
    {
        .id = "rate_flicker",
        .equation = "R += noise of density S(f) = h/f, levelling off at highest_frequency; h = "
                    "density^2/(ln(1.78 duration highest_frequency) + 0.915)",
        .explanation = "A floor of 1/f noise that no averaging brings down: Allan deviation sqrt(2 ln2 h), "
                       "flat. The variance about the mean of a recording of length T is the integral of S (1 "
                       "- sinc^2(pi f T)), which is h (ln(T f_high) + ln(2 pi) + Euler - 3/2).",
        .channels = {"rate_dph"},
        .confused_with = {"rate_random_walk", "thermal_gradient_bias"},
        .separated_by = "long hold, and a test of the spectrum's shape: a noise is no function of any input",
        .parameters =
            {
                {"density", "deg/h", 0.05, 0.0, 100.0, "standard deviation over the recording"},
                {"duration", "s", 18000.0, 10.0, 1e7, "length of the recording"},
                {"highest_frequency", "Hz", 1.0, 1e-3, 1e3, "where the 1/f law ends"},
            },
    },
    construct<RateFlicker>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <stdexcept>

#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class OscillatorTemperature : public Effect {
 public:
  OscillatorTemperature(const EffectValues& values, const Instrument&, std::uint64_t)
      : inflection_degc_(values.at("inflection")), turning_degc_(values.at("turning")) {
    const double low = values.at("board_low") - inflection_degc_;
    const double high = values.at("board_high") - inflection_degc_;
    if (low >= high)
      throw std::invalid_argument("effect oscillator_temperature: board_low must lie below board_high");
    std::array<double, 4> extremes = {shape(low), shape(high), shape(std::clamp(-turning_degc_, low, high)),
                                      shape(std::clamp(turning_degc_, low, high))};
    const auto [least, most] = std::minmax_element(extremes.begin(), extremes.end());
    scale_ = 1e-6 * values.at("ppm_span") / (*most - *least);
  }

  void act(const Conditions& now, double, Parameters& p) override {
    p.oscillator_error += scale_ * shape(now.temperatures.board_degc - inflection_degc_);
  }

 private:
  double shape(double u) const { return u * (u * u - 3.0 * turning_degc_ * turning_degc_); }

  double inflection_degc_;
  double turning_degc_;
  double scale_ = 0.0;
};

const Registration kEntry{
    {
        .id = "oscillator_temperature",
        .equation = "f_counted = f (1 - y), y = c (u^3 - 3 u_t^2 u), u = T_board - T_i",
        .explanation =
            "The board's oscillator is an AT-cut crystal: its frequency follows a cubic of the board's "
            "temperature about the inflection T_i, with turning points u_t to both sides. All that is "
            "counted against it moves the other way, every line of the raw pickoffs too; the rate does not.",
        .channels = {"frequency_hz", "adc_x", "adc_y"},
        .confused_with = {"frequency_polynomial_order"},
        .separated_by = "board and case temperatures that differ (power-on, another heat load)",
        .parameters =
            {
                {"ppm_span", "ppm", 10.0, -200.0, 200.0,
                 "peak to peak of y over the board temperatures below; negative: the curve upside down"},
                {"board_low", "degC", -12.0, -100.0, 150.0, "lowest board temperature"},
                {"board_high", "degC", 48.0, -100.0, 150.0, "highest board temperature"},
                {"inflection", "degC", 27.0, -50.0, 100.0, "T_i"},
                {"turning", "degC", 30.0, 0.0, 150.0, "u_t"},
            },
    },
    construct<OscillatorTemperature>};

}  // namespace
}  // namespace hemi::physics

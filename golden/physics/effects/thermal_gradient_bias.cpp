// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"
#include "golden/physics/thermal_network.hpp"

namespace hemi::physics {
namespace {

class ThermalGradientBias : public Effect {
 public:
  ThermalGradientBias(const EffectValues& values, const Instrument&, std::uint64_t)
      : gain_rad_s_degc_(values.at("gain") * kRadPerSecondPerDph), node_(values.at("node_time_constant")) {}

  void act(const Conditions& now, double dt_s, Parameters& p) override {
    const double case_degc = now.temperatures.case_degc;
    if (!started_) node_degc_ = former_case_degc_ = case_degc;
    started_ = true;
    node_degc_ = node_.advance(node_degc_, former_case_degc_, case_degc, dt_s);
    former_case_degc_ = case_degc;
    p.rate_rad_s += gain_rad_s_degc_ * (case_degc - node_degc_);
  }

 private:
  double gain_rad_s_degc_;
  Pole node_;
  bool started_ = false;
  double node_degc_ = 0.0;
  double former_case_degc_ = 0.0;
};

const Registration kEntry{
    {
        .id = "thermal_gradient_bias",
        .equation = "R += gain (T_case - T_node), tau_node T_node' = T_case - T_node",
        .explanation = "Temperature differences inside the case bend it and shift the electrodes. They "
                       "follow the case with a lag that is not the shell's, so that no term in df/dt "
                       "describes them: the rate moves before the frequency does.",
        .channels = {"rate_dph"},
        .confused_with = {"thermal_hysteresis", "demodulation_phase"},
        .separated_by = "steps of the case against ramps: the bias follows the node's own lag",
        .parameters =
            {
                {"gain", "deg/h/degC", 0.5, -100.0, 100.0, "rate for each degree between case and node"},
                {"node_time_constant", "s", 400.0, 1.0, 2e4, "lag of the node behind the case"},
            },
    },
    construct<ThermalGradientBias>};

}  // namespace
}  // namespace hemi::physics

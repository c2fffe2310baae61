// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class GasLeak : public Effect {
 public:
  GasLeak(const EffectValues& values, const Instrument& instrument, std::uint64_t)
      : damping20_per_s_(instrument.at(20.0).damping_per_s),
        rate_per_s_(values.at("rate") / 3600.0),
        initial_(values.at("initial")) {}

  void act(const Conditions&, double dt_s, Parameters& p) override {
    elapsed_s_ += dt_s;
    p.damping_per_s += damping20_per_s_ * (initial_ + rate_per_s_ * elapsed_s_);
  }

 private:
  double damping20_per_s_;
  double rate_per_s_;
  double initial_;
  double elapsed_s_ = 0.0;
};

const Registration kEntry{
    {
        .id = "gas_leak",
        .equation = "1/tau = 1/tau0 + rate t/tau20",
        .explanation = "The vacuum gets worse: gas damping is proportional to the pressure, which rises in "
                       "time. The drive grows, the frequency does not move.",
        .channels = {"drive_v"},
        .confused_with = {"damping_temperature", "damping_anisotropy"},
        .separated_by = "isothermal hold",
        .parameters =
            {
                {"rate", "1/h", 0.01, -0.1, 10.0, "growth of the drive relative to that at 20 degC"},
                {"initial", "1", 0.0, 0.0, 10.0, "gas damping at the start, relative likewise"},
            },
    },
    construct<GasLeak>};

}  // namespace
}  // namespace hemi::physics

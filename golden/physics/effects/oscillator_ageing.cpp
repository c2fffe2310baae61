// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/effect.hpp"

namespace hemi::physics {
namespace {

class OscillatorAgeing : public Effect {
 public:
  OscillatorAgeing(const EffectValues& values, const Instrument&, std::uint64_t)
      : rate_per_s_(values.at("rate") * 1e-6 / 86400.0) {}

  void act(const Conditions&, double dt_s, Parameters& p) override {
    elapsed_s_ += dt_s;
    p.oscillator_error += rate_per_s_ * elapsed_s_;
  }

 private:
  double rate_per_s_;
  double elapsed_s_ = 0.0;
};

const Registration kEntry{{
                              .id = "oscillator_ageing",
                              .equation = "f_counted = f (1 - y), y = rate t",
                              .explanation = "The board's oscillator ages: all that is counted against it "
                                             "drifts one way, at every temperature alike.",
                              .channels = {"frequency_hz", "adc_x", "adc_y"},
                              .confused_with = {"frequency_ageing"},
                              .separated_by = "not separable without a second clock",
                              .parameters =
                                  {
                                      {"rate", "ppm/day", 0.1, -100.0, 100.0, "growth of y since the start"},
                                  },
                          },
                          construct<OscillatorAgeing>};

}  // namespace
}  // namespace hemi::physics

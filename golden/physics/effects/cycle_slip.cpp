// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "golden/physics/effect.hpp"
#include "golden/physics/positions.hpp"

namespace hemi::physics {
namespace {

class CycleSlip : public Effect {
 public:
  CycleSlip(const EffectValues& values, const Instrument&, std::uint64_t seed)
      : count_(static_cast<std::size_t>(std::llround(values.at("count")))), seed_(seed) {}

  void distort(std::vector<TelemetrySample>& telemetry) override {
    std::mt19937_64 random(seed_);
    for (const std::size_t i : distinct_positions(1, telemetry.size(), count_, random)) {
      const double turns = random() >> 63 ? 1.0 : -1.0;
      telemetry[i].frequency_hz += turns / (telemetry[i].time_s - telemetry[i - 1].time_s);
    }
  }

 private:
  std::size_t count_;
  std::uint64_t seed_;
};

const Registration kEntry{{
                              .id = "cycle_slip",
                              .equation = "f += +-1 turn / interval in single samples",
                              .explanation = "The loop slips a turn: the phase jumps, and the counted "
                                             "frequency has a pulse of area 1 in one sample.",
                              .channels = {"frequency_hz"},
                              .confused_with = {"sample_loss"},
                              .separated_by = "the core's lock and gap counters",
                              .parameters =
                                  {
                                      {"count", "1", 5.0, 0.0, 1e6, "number of slips"},
                                  },
                          },
                          construct<CycleSlip>};

}  // namespace
}  // namespace hemi::physics

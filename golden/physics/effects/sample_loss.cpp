// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "golden/physics/effect.hpp"
#include "golden/physics/positions.hpp"

namespace hemi::physics {
namespace {

class SampleLoss : public Effect {
 public:
  SampleLoss(const EffectValues& values, const Instrument&, std::uint64_t seed)
      : count_(static_cast<std::size_t>(std::llround(values.at("count")))),
        dropped_(values.at("dropped") >= 0.5),
        seed_(seed) {}

  void distort(std::vector<TelemetrySample>& telemetry) override {
    std::mt19937_64 random(seed_);
    const std::vector<std::size_t> lost = distinct_positions(1, telemetry.size(), count_, random);
    for (auto i = lost.rbegin(); dropped_ && i != lost.rend(); ++i) {
      telemetry.erase(telemetry.begin() + static_cast<std::ptrdiff_t>(*i));
    }
    for (auto i = lost.begin(); !dropped_ && i != lost.end(); ++i) {
      TelemetrySample& sample = telemetry[*i];
      const TelemetrySample& last = telemetry[*i - 1];
      sample.frequency_hz = last.frequency_hz;
      sample.amplitude = last.amplitude;
      sample.drive_v = last.drive_v;
      sample.quadrature_v = last.quadrature_v;
      sample.rate_dph = last.rate_dph;
    }
  }

 private:
  std::size_t count_;
  bool dropped_;
  std::uint64_t seed_;
};

const Registration kEntry{
    {
        .id = "sample_loss",
        .equation = "sample[i] = sample[i - 1], or row i is missing",
        .explanation = "The link loses samples: the receiver repeats the last one under the new time stamp, "
                       "or leaves a gap in time.",
        .channels = {"frequency_hz", "amplitude", "drive_v", "quadrature_v", "rate_dph"},
        .confused_with = {"cycle_slip"},
        .separated_by = "the core's counters; repeated values are equal in every digit",
        .parameters =
            {
                {"count", "1", 5.0, 0.0, 1e6, "number of samples lost"},
                {"dropped", "1", 0.0, 0.0, 1.0, "0: repeated, 1: the rows are missing"},
            },
    },
    construct<SampleLoss>};

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
// The plant closed around an engine, sample by sample.
#ifndef HEMI_TB_CLOSED_LOOP_HPP
#define HEMI_TB_CLOSED_LOOP_HPP

#include <cstddef>
#include <vector>

#include "golden/physics/plant.hpp"
#include "tb/engine.hpp"

namespace hemi::tb {

/// Nobody watches and nothing happens to the samples on their way.
struct Untouched {
  void operator()(SamplePair&) const {}
  void operator()(const SamplePair&, const DacWords&) const {}
};

/// Runs `count` samples of `plant` through `engine` and its words back into the plant; appends the records.
/// `on_sample(SamplePair&)` may spoil a sample before the core sees it (a lost signal, a gap);
/// `on_words(pair, words)` sees what came of it. Neither engine nor plant is drained or reset: calls continue
/// where the last one stopped.
template <class EngineType, class OnSample = Untouched, class OnWords = Untouched>
void close_loop(EngineType& engine, physics::Plant& plant, std::size_t count, std::vector<Record>& records,
                OnSample&& on_sample = {}, OnWords&& on_words = {}) {
  for (std::size_t i = 0; i < count; ++i) {
    const physics::AdcPair adc = plant.sample();
    SamplePair pair{adc.x, adc.y, false};
    on_sample(pair);
    const DacWords words = engine.step(pair, records);
    on_words(pair, words);
    plant.act({static_cast<std::int16_t>(words.drive), static_cast<std::int16_t>(words.rebalance),
               static_cast<std::int16_t>(words.quadrature)});
  }
}

}  // namespace hemi::tb

#endif  // HEMI_TB_CLOSED_LOOP_HPP

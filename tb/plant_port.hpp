// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TB_PLANT_PORT_HPP
#define HEMI_TB_PLANT_PORT_HPP

#include "tb/engine.hpp"

namespace hemi::tb {

/// A plant as a bench sees it: for each sample one pair of ADC words and, after it, what the DACs got.
class PlantPort {
 public:
  virtual ~PlantPort() = default;
  /// ADC words of the next sample [LSB].
  virtual SamplePair sample() = 0;
  /// DAC words that the core gave for that sample; their delay is the plant's business.
  virtual void act(const DacWords& words) = 0;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_PLANT_PORT_HPP

// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TB_BOARD_WORLD_HPP
#define HEMI_TB_BOARD_WORLD_HPP

#include "golden/physics/plant.hpp"
#include "tb/plant_port.hpp"

namespace hemi::tb {

/// The physics as a bench's plant.
class PhysicsPort : public PlantPort {
 public:
  explicit PhysicsPort(physics::Plant& plant) : plant_(plant) {}

  SamplePair sample() override {
    const physics::AdcPair pair = plant_.sample();
    return {pair.x, pair.y, false};
  }

  void act(const DacWords& words) override {
    plant_.act({static_cast<std::int16_t>(words.drive), static_cast<std::int16_t>(words.rebalance),
                static_cast<std::int16_t>(words.quadrature)});
  }

 private:
  physics::Plant& plant_;
};

/// What the simulated board is connected to.
struct BoardWorld {
  double temperature_degc = 20.0;
  double rate_dps = 0.0;
  double amplitude = 1.0;  ///< at the start, in nominal amplitudes
  std::uint64_t seed = 1;
};

/// The nominal instrument at one temperature and rate.
inline physics::Plant plant_of(const BoardWorld& world) {
  const physics::Instrument instrument;
  physics::Parameters parameters = instrument.at(world.temperature_degc);
  parameters.rate_rad_s = world.rate_dps * std::numbers::pi / 180.0;
  physics::PlantConfiguration configuration;
  configuration.start.x_amplitude = world.amplitude;
  configuration.seed = world.seed;
  return {instrument, parameters, configuration};
}

}  // namespace hemi::tb

#endif  // HEMI_TB_BOARD_WORLD_HPP

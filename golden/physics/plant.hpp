// SPDX-License-Identifier: Apache-2.0
// The instrument around the signal core at the ADC's rate: DAC words in, ADC words out.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "golden/physics/converters.hpp"
#include "golden/physics/instrument.hpp"
#include "golden/physics/noise.hpp"
#include "golden/physics/parameters.hpp"
#include "golden/physics/resonator.hpp"
#include "golden/physics/world.hpp"

namespace hemi::physics {

/// Gives the parameters that hold around `time_s`. Asked in order of time. amplitude: of the primary, nominal
/// amplitudes.
using ParameterSource = std::function<Parameters(double time_s, double amplitude)>;

/// The world along a profile of inputs. The caller keeps a share of the world, for its temperatures and true
/// frequency.
inline ParameterSource follow(std::shared_ptr<World> world,
                              std::function<Environment(double time_s)> profile) {
  return [world = std::move(world), profile = std::move(profile)](double time_s, double amplitude) {
    Environment environment = profile(time_s);
    environment.time_s = time_s;
    world->advance(environment, amplitude);
    return world->parameters();
  };
}

/// x = a cos(phase + w t), y likewise, a in nominal amplitudes, phases in rad.
struct InitialVibration {
  double x_amplitude = 0.0;
  double x_phase_rad = 0.0;
  double y_amplitude = 0.0;
  double y_phase_rad = 0.0;
};

struct PlantConfiguration {
  AdcConfiguration adc = AdcConfiguration::reference();
  InitialVibration start;
  double start_s = 0.0;
  double update_s = 1e-3;  ///< by the board's clock, between changes of the parameters; rounded to samples
  std::uint64_t seed = 0;
};

/// Resonator, electrodes, pickoffs and converters (docs/physics.md).
///
/// Instant n is n periods of the board's clock after the start. sample() reads the pickoffs at instant n;
/// act() then takes the words that were computed from that sample, which act from instant n + 2 to n + 3, and
/// goes on to instant n + 1. Before the first words arrive the DACs are at zero. The same seed and words give
/// the same samples, bit for bit on one machine.
class Plant {
 public:
  /// Throws std::invalid_argument for an ADC below 16 bit or a rate or an update interval that is not
  /// positive.
  Plant(const Instrument& instrument, ParameterSource source, const PlantConfiguration& configuration);
  /// Parameters that never change.
  Plant(const Instrument& instrument, const Parameters& constant, const PlantConfiguration& configuration);

  /// ADC words of this instant. To be called once an instant: the noise is new each time.
  AdcPair sample();
  /// Advances by one period of the board's clock.
  void act(DacWords words);

  /// True time of this instant.
  double time_s() const { return update_start_s_ + (samples_an_update_ - samples_left_) * step_s_; }
  Motion motion() const { return resonator_.motion(); }
  double amplitude() const { return resonator_.amplitude(); }
  const Parameters& parameters() const { return parameters_; }

 private:
  struct Forces {
    double drive = 0.0;
    double x = 0.0;
    double y = 0.0;
    double quadrature = 0.0;
  };
  // fraction of full scale = gain (u + a2 u^2 + a3 u^3), u = in_phase p + lead p'/s
  struct Pickoff {
    double gain = 0.0;
    double in_phase = 1.0;
    double lead = 0.0;
  };

  // A push on each axis every so many samples, x and y in turn. Pulses of independent strength have a white
  // spectrum whatever their distance T; what T brings is correlation between frequencies 1/T apart, 25 kHz
  // here, and that joins the two sides of the carrier's spectrum only if 2 f comes within the loops'
  // bandwidth of a multiple of 1/T.
  static constexpr int kSamplesAPush = 4;

  void update();
  void set_electronics();
  double response(const Pickoff& pickoff, double displacement) const {
    return pickoff.gain * displacement * (1.0 + displacement * (quadratic_ + displacement * cubic_));
  }
  void push();

  Instrument instrument_;
  ParameterSource source_;
  Parameters parameters_;
  double nominal_omega_rad_s_;
  double period_s_;  // of the board's clock, nominal

  Resonator resonator_;
  double step_s_ = 0.0;
  double update_start_s_;
  int samples_an_update_;
  int samples_left_ = 0;
  int pushes_ = 0;

  // forces per mass of full scale
  double drive_x_ = 0.0;
  double drive_y_ = 0.0;
  double rebalance_y_ = 0.0;
  Forces newer_;
  Forces older_;
  double held_drive_ = 0.0;  // while the present instant is sampled

  Pickoff pickoff_x_;
  Pickoff pickoff_y_;
  double quadratic_ = 0.0;
  double cubic_ = 0.0;
  Adc adc_x_;
  Adc adc_y_;

  Gaussian pickoff_noise_;
  Gaussian force_noise_;
  Gaussian oscillator_noise_;
  FlickerNoise rate_flicker_;
  double pickoff_deviation_codes_;
  double push_deviation_;
  double oscillator_deviation_;
};

// Here, not in the source file: called at every sample, and a fifth faster where the compiler sees them.
inline AdcPair Plant::sample() {
  const double x = resonator_.x();
  const double y = pickoff_y_.in_phase * resonator_.y() + pickoff_y_.lead * resonator_.scaled_y_rate();
  const double x_fraction = response(pickoff_x_, x) + parameters_.drive_feedthrough * held_drive_;
  return {adc_x_.convert(x_fraction, pickoff_deviation_codes_ * pickoff_noise_()),
          adc_y_.convert(response(pickoff_y_, y), pickoff_deviation_codes_ * pickoff_noise_())};
}

inline void Plant::act(DacWords words) {
  const Forces now = older_;
  older_ = newer_;
  const double drive = dac_fraction(words.drive);
  newer_ = {drive, drive_x_ * drive, drive_y_ * drive + rebalance_y_ * dac_fraction(words.rebalance),
            dac_fraction(words.quadrature)};
  resonator_.step(now.x, now.y, now.quadrature);
  push();
  held_drive_ = now.drive;
  if (--samples_left_ == 0) {
    update_start_s_ += samples_an_update_ * step_s_;
    samples_left_ = samples_an_update_;
    update();
  }
}

inline void Plant::push() {
  static_assert(kSamplesAPush == 4);
  pushes_ = (pushes_ + 1) % kSamplesAPush;
  if (pushes_ == 1) resonator_.push_x(push_deviation_ * force_noise_());
  if (pushes_ == 3) resonator_.push_y(push_deviation_ * force_noise_());
}

}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/chain/reference_phase_loop.hpp"

namespace hemi::golden {
namespace {

/// angle in [-w, w) turns, w = 2^log2 of the angle word's unit.
bool within(double angle, int log2) {
  const double window = power_of_two(log2 - config::angle.fraction);
  return -window <= angle && angle < window;
}

}  // namespace

void ReferencePhaseLoop::steer(double phase_error, double difference) {
  // A gain of 24 bits times an angle of 32 bits can need 54: hence the product that is rounded as a whole.
  const auto add = [this](double sum, double error, double gain) {
    const double step = arithmetic_.round_product(error, gain, config::increment.fraction);
    return arithmetic_.saturate(sum + step, config::increment, clipped_);
  };
  if (!locked_ && !within(difference, config::steering_window_log2)) {
    integral_ = add(integral_, difference, settings_.frequency);
  }
  integral_ = add(integral_, phase_error, settings_.integral);
  increment_ = add(integral_, phase_error, settings_.proportional);
}

void ReferencePhaseLoop::judge(double phase_error) {
  counter_ = within(phase_error, config::lock_window_log2) ? std::min(counter_ + 1.0, settings_.lock_count)
                                                           : std::max(counter_ - config::lock_penalty, 0.0);
}

void ReferencePhaseLoop::tick(const Polar& detected) {
  clipped_ = false;
  low_ = detected.amplitude < settings_.amplitude_threshold;
  const double difference = modulo(detected.phase_error - last_error_, 1.0);
  last_error_ = detected.phase_error;
  if (low_) {
    increment_ = integral_;
  } else {
    steer(detected.phase_error, difference);
    judge(detected.phase_error);
  }
  if (counter_ >= settings_.lock_count) locked_ = true;
  if (counter_ == 0.0) locked_ = false;
}

}  // namespace hemi::golden

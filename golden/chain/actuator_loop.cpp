// SPDX-License-Identifier: Apache-2.0
#include "golden/chain/actuator_loop.hpp"

namespace hemi::golden {

using namespace config;

double ActuatorLoop::within_limits(double value) const {
  return std::clamp(value, 0.0 - settings_.limit, settings_.limit);
}

void ActuatorLoop::control(double error, double integral_gain) {
  bool ignored = false;  // by contract an error or a gain beyond its words raises nothing of its own
  const double e = arithmetic_.saturate(arithmetic_.round(error, baseband.fraction), baseband, ignored);
  const auto part = [&](double gain) {
    return arithmetic_.saturate(arithmetic_.round(e * gain, command_integral.fraction), command_integral,
                                ignored);
  };
  const double proportional = part(settings_.proportional);
  const double step = part(integral_gain);
  const double wanted = integral_ + proportional + step;
  saturated_ = wanted != within_limits(wanted);
  const bool outwards = (step < 0.0) == (wanted < 0.0);
  if (!saturated_ || !outwards) integral_ = within_limits(integral_ + step);
  command_ = arithmetic_.floor(within_limits(integral_ + proportional), config::command.fraction);
}

void ActuatorLoop::tick(LoopMode mode, double error) {
  saturated_ = false;
  switch (mode) {
    case LoopMode::off:
      integral_ = settings_.start;
      command_ = 0.0;
      break;
    case LoopMode::hold:
      command_ = arithmetic_.floor(integral_, config::command.fraction);
      break;
    case LoopMode::proportional:
      control(error, 0.0);
      break;
    case LoopMode::closed:
      control(error, settings_.integral);
      break;
  }
}

}  // namespace hemi::golden

// SPDX-License-Identifier: Apache-2.0
// Tops of the kernels that work at each tick and close the loops.
#include "hls/image_filter.hpp"
#include "hls/phase_detector.hpp"
#include "hls/reference_phase_loop.hpp"
#include "hls/start_up.hpp"
#include "hls/tops/ports.hpp"
#include "hls/tops/tops.hpp"

using namespace hemi::hls;
namespace config = hemi::config;

namespace {

/// Any of the three actuator loops; `Proportional` and `Integral` are the registers of its gains.
template <int Proportional, int Integral>
void actuator_loop(ActuatorLoop& loop, bool reset, std::int32_t mode, std::int32_t error,
                   std::int32_t proportional, std::int32_t integral_gain, const Command& start,
                   std::int32_t limit, std::int64_t* integral, std::int32_t* command, bool* saturated) {
  bool clipped = false;
  if (reset) {
    loop.reset(Command());
  } else {
    loop.step(static_cast<LoopMode>(mode), from_raw<hemi::hls::Baseband>(error),
              from_raw<RegisterWord<Proportional>>(proportional),
              from_raw<RegisterWord<Integral>>(integral_gain), start, from_raw<Command>(limit), clipped);
  }
  *integral = raw(loop.integral());
  *command = word(loop.command());
  *saturated = clipped;
}

}  // namespace

HEMI_TOP_OUTPUT(baseband_xi)
HEMI_TOP_OUTPUT(baseband_xq)
HEMI_TOP_OUTPUT(baseband_yi)
HEMI_TOP_OUTPUT(baseband_yq)
extern "C" void hemi_image_filter(bool reset, std::int32_t xi, std::int32_t xq, std::int32_t yi,
                                  std::int32_t yq, std::int32_t* baseband_xi, std::int32_t* baseband_xq,
                                  std::int32_t* baseband_yi, std::int32_t* baseband_yq) {
  static ImageFilter filter[4];
  const std::int32_t in[4] = {xi, xq, yi, yq};
  std::int32_t out[4] = {0, 0, 0, 0};
  for (int i = 0; i < 4; ++i) {
    if (reset) {
      filter[i].reset();
    } else {
      out[i] = word(filter[i].step(from_raw<Baseband>(in[i])));
    }
  }
  *baseband_xi = out[0];
  *baseband_xq = out[1];
  *baseband_yi = out[2];
  *baseband_yq = out[3];
}

HEMI_TOP_OUTPUT(amplitude)
HEMI_TOP_OUTPUT(phase_error)
HEMI_TOP_OUTPUT(in_phase)
HEMI_TOP_OUTPUT(quadrature)
HEMI_TOP_OUTPUT(saturated)
extern "C" void hemi_phase_detector(std::int32_t xi, std::int32_t xq, std::int32_t yi, std::int32_t yq,
                                    std::int32_t demodulation_cos, std::int32_t demodulation_sin,
                                    std::int64_t* amplitude, std::int32_t* phase_error,
                                    std::int32_t* in_phase, std::int32_t* quadrature, bool* saturated) {
  bool clipped = false;
  const Polar polar = PhaseDetector::vectoring(from_raw<Baseband>(xi), from_raw<Baseband>(xq));
  const Secondary secondary =
      PhaseDetector::rotate(from_raw<Baseband>(yi), from_raw<Baseband>(yq),
                            from_raw<RegisterWord<config::reg_demodulation_cos>>(demodulation_cos),
                            from_raw<RegisterWord<config::reg_demodulation_sin>>(demodulation_sin), clipped);
  *amplitude = raw(polar.amplitude);
  *phase_error = word(polar.phase_error);
  *in_phase = word(secondary.in_phase);
  *quadrature = word(secondary.quadrature);
  *saturated = clipped;
}

HEMI_TOP_OUTPUT(state)
HEMI_TOP_OUTPUT(restart)
HEMI_TOP_OUTPUT(start)
HEMI_TOP_OUTPUT(mode_amplitude)
HEMI_TOP_OUTPUT(mode_quadrature)
HEMI_TOP_OUTPUT(mode_rebalance)
extern "C" void hemi_start_up(bool reset, std::int64_t amplitude, bool locked, bool control,
                              std::int64_t amplitude_threshold, std::int64_t search_amplitude,
                              std::int64_t closing_amplitude, std::int32_t search_ticks,
                              std::int64_t nco_start, std::int64_t search_step, std::int64_t search_span,
                              std::int32_t holdover_ticks, std::int32_t* state, bool* restart,
                              std::int64_t* start, std::int32_t* mode_amplitude,
                              std::int32_t* mode_quadrature, std::int32_t* mode_rebalance) {
  static StartUp start_up;
  Registers r;
  r.control = control ? 1 : 0;
  r.amplitude_threshold = from_raw<CordicWord>(amplitude_threshold);
  r.search_amplitude = from_raw<CordicWord>(search_amplitude);
  r.closing_amplitude = from_raw<CordicWord>(closing_amplitude);
  r.search_ticks = search_ticks;
  r.nco_start = from_raw<Increment>(nco_start);
  r.search_step = from_raw<Increment>(search_step);
  r.search_span = from_raw<Increment>(search_span);
  r.holdover_ticks = holdover_ticks;
  bool again = false;
  if (reset) {
    start_up.reset();
  } else {
    again = start_up.step(from_raw<CordicWord>(amplitude), locked, r);
  }
  *state = start_up.state();
  *restart = again;
  *start = raw(start_up.start(r));
  *mode_amplitude = static_cast<std::int32_t>(start_up.amplitude_mode());
  *mode_quadrature = static_cast<std::int32_t>(start_up.quadrature_mode());
  *mode_rebalance = static_cast<std::int32_t>(start_up.rebalance_mode());
}

HEMI_TOP_OUTPUT(increment)
HEMI_TOP_OUTPUT(integral)
HEMI_TOP_OUTPUT(counter)
HEMI_TOP_OUTPUT(locked)
HEMI_TOP_OUTPUT(holdover)
HEMI_TOP_OUTPUT(saturated)
extern "C" void hemi_reference_phase_loop(std::uint8_t reset, std::uint8_t restart, std::int64_t start,
                                          std::int64_t amplitude, std::int32_t phase_error,
                                          std::int32_t loop_proportional, std::int32_t loop_integral,
                                          std::int32_t loop_frequency, std::int64_t amplitude_threshold,
                                          std::int32_t lock_count, std::int64_t* increment,
                                          std::int64_t* integral, std::int32_t* counter, bool* locked,
                                          bool* holdover, bool* saturated) {
  static ReferencePhaseLoop loop;
  Registers r;
  r.loop_proportional = from_raw<RegisterWord<config::reg_loop_proportional>>(loop_proportional);
  r.loop_integral = from_raw<RegisterWord<config::reg_loop_integral>>(loop_integral);
  r.loop_frequency = from_raw<RegisterWord<config::reg_loop_frequency>>(loop_frequency);
  r.amplitude_threshold = from_raw<CordicWord>(amplitude_threshold);
  r.lock_count = from_raw<RegisterWord<config::reg_lock_count>>(lock_count);
  bool clipped = false;
  if (reset != 0) {
    loop.reset(from_raw<Increment>(start));
  } else {
    if (restart != 0) loop.restart(from_raw<Increment>(start));
    const Polar polar = {from_raw<CordicWord>(amplitude), from_raw<Angle>(phase_error)};
    loop.step(polar, r, clipped);
  }
  *increment = raw(loop.increment());
  *integral = raw(loop.integral());
  *counter = loop.counter();
  *locked = loop.locked();
  *holdover = loop.holdover();
  *saturated = clipped;
}

HEMI_TOP_OUTPUT(integral)
HEMI_TOP_OUTPUT(command)
HEMI_TOP_OUTPUT(saturated)
extern "C" void hemi_amplitude_loop(bool reset, std::int32_t mode, std::int32_t error,
                                    std::int32_t proportional, std::int32_t integral_gain, std::int32_t start,
                                    std::int32_t limit, std::int64_t* integral, std::int32_t* command,
                                    bool* saturated) {
  static ActuatorLoop loop;
  actuator_loop<config::reg_amplitude_proportional, config::reg_amplitude_integral>(
      loop, reset, mode, error, proportional, integral_gain, from_raw<Command>(start), limit, integral,
      command, saturated);
}

HEMI_TOP_OUTPUT(integral)
HEMI_TOP_OUTPUT(command)
HEMI_TOP_OUTPUT(saturated)
extern "C" void hemi_quadrature_loop(bool reset, std::int32_t mode, std::int32_t error,
                                     std::int32_t proportional, std::int32_t integral_gain,
                                     std::int32_t start, std::int32_t limit, std::int64_t* integral,
                                     std::int32_t* command, bool* saturated) {
  static ActuatorLoop loop;
  actuator_loop<config::reg_quadrature_proportional, config::reg_quadrature_integral>(
      loop, reset, mode, error, proportional, integral_gain, from_raw<Command>(start), limit, integral,
      command, saturated);
}

HEMI_TOP_OUTPUT(integral)
HEMI_TOP_OUTPUT(command)
HEMI_TOP_OUTPUT(saturated)
extern "C" void hemi_rebalance_loop(bool reset, std::int32_t mode, std::int32_t error,
                                    std::int32_t proportional, std::int32_t integral_gain, std::int32_t limit,
                                    std::int64_t* integral, std::int32_t* command, bool* saturated) {
  static ActuatorLoop loop;
  actuator_loop<config::reg_rebalance_proportional, config::reg_rebalance_integral>(
      loop, reset, mode, error, proportional, integral_gain, Command(), limit, integral, command, saturated);
}

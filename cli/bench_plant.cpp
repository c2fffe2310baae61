// SPDX-License-Identifier: Apache-2.0
#include "cli/bench_plant.hpp"

#include <algorithm>
#include <chrono>

#include "cli/engines.hpp"
#include "cli/recording/interrupt.hpp"
#include "golden/loops/control.hpp"
#include "golden/physics/slow_twin.hpp"
#include "tb/closed_loop.hpp"

namespace hemi::cli {
namespace {

using Clock = std::chrono::steady_clock;

double since_s(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

std::vector<double> closed_loop_speed(const std::string& engine_name, double seconds, int repetitions) {
  const physics::Instrument instrument;
  tb::RegisterValues values{};
  loops::set_control(values, instrument, loops::CoreSampling::reference());
  const auto engine = make_engine(engine_name, false);
  engine->reset(values);
  physics::PlantConfiguration configuration;
  configuration.start = {1.0, 0.0, 0.0, 0.0};
  physics::Plant plant(instrument, instrument.at(20.0), configuration);
  std::vector<tb::Record> records;
  std::vector<double> speeds;
  // The first repetition warms up.
  for (int k = 0; k <= repetitions; ++k) {
    constexpr std::size_t piece = 2000;
    std::size_t done = 0;
    const auto start = Clock::now();
    double elapsed_s = 0.0;
    do {
      records.clear();
      tb::close_loop(*engine, plant, piece, records);
      done += piece;
      recording::check_interrupt();
      elapsed_s = since_s(start);
    } while (elapsed_s < seconds);
    if (k > 0) speeds.push_back(static_cast<double>(done) / config::Reference::adc_rate_hz / elapsed_s);
  }
  std::sort(speeds.begin(), speeds.end());
  return speeds;
}

std::vector<double> slow_twin_ms(int repetitions) {
  constexpr std::size_t samples = 5 * 3600;
  const auto cooling = [](double t) {
    physics::Environment e;
    e.chamber_degc = std::max(-20.0, 20.0 - t / 60.0);
    return e;
  };
  const auto inputs = physics::sample_inputs(cooling, 0.0, 1.0, samples);
  std::vector<double> times;
  for (int k = 0; k <= repetitions; ++k) {
    const auto start = Clock::now();
    const auto telemetry = physics::simulate_slow(physics::Instrument{}, {}, inputs);
    const double ms = since_s(start) * 1e3;
    if (k > 0 && telemetry.size() == samples) times.push_back(ms);
    recording::check_interrupt();
  }
  std::sort(times.begin(), times.end());
  return times;
}

}  // namespace hemi::cli

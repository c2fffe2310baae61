// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "cli/bench_plant.hpp"
#include "cli/commands.hpp"
#include "cli/engines.hpp"
#include "cli/options.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/settings.hpp"
#include "tb/sc_fixed_chain.hpp"

namespace hemi::cli {
namespace {

struct BenchOptions {
  double seconds = 1.0;
  int repetitions = 5;
  std::vector<std::string> engines;
  bool json = false;
};

/// A noisy tone of the reference instrument: 0.8 of full scale, 0.5 LSB rms.
std::vector<tb::SamplePair> tone(std::size_t n) {
  constexpr double amplitude_lsb = 0.8 * 32768.0;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> noise_lsb(0.0, 0.5);
  std::vector<tb::SamplePair> pairs(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double theta = 2.0 * std::numbers::pi * std::fmod(0.04425 * static_cast<double>(i), 1.0);
    pairs[i].x =
        static_cast<std::int32_t>(std::lround(amplitude_lsb * std::cos(theta) + noise_lsb(generator)));
    pairs[i].y =
        static_cast<std::int32_t>(std::lround(0.01 * amplitude_lsb * std::cos(theta) + noise_lsb(generator)));
  }
  return pairs;
}

Setup bench_setup() {
  recording::RawCapture capture;
  capture.sample_rate_hz = config::Reference::adc_rate_hz;
  capture.full_scale_lsb = 32768.0;
  return capture_setup(capture, nullptr, 4425.0, std::nullopt);
}

struct Result {
  std::string engine;
  std::vector<double> pairs_per_s;  ///< sorted
  double median() const { return pairs_per_s[pairs_per_s.size() / 2]; }
};

/// Feeds the tone again and again for about `seconds`, in several timed repetitions.
Result measure(tb::Engine& engine, const std::vector<tb::SamplePair>& pairs, const BenchOptions& options) {
  using Clock = std::chrono::steady_clock;
  engine.reset(bench_setup().values);
  Result result{engine.name(), {}};
  std::vector<tb::Record> records;
  const double share = options.seconds / options.repetitions;
  // A piece is small enough for the slowest engine to stop in time and large enough to hide the call.
  std::size_t piece = 500;
  for (int k = 0; k <= options.repetitions; ++k) {
    std::size_t done = 0, at = 0;
    const auto start = Clock::now();
    double elapsed = 0;
    do {
      const std::size_t n = std::min(piece, pairs.size() - at);
      records.clear();
      engine.samples({pairs.data() + at, n}, records);
      at = (at + n) % pairs.size();
      done += n;
      elapsed = std::chrono::duration<double>(Clock::now() - start).count();
      recording::check_interrupt();
    } while (elapsed < share);
    // The first repetition warms up and finds the piece that takes a hundredth of a repetition.
    if (k == 0)
      piece = std::clamp<std::size_t>(done / 100, 500, pairs.size());
    else
      result.pairs_per_s.push_back(static_cast<double>(done) / elapsed);
  }
  std::sort(result.pairs_per_s.begin(), result.pairs_per_s.end());
  return result;
}

/// The simulations: plant around hls and rtl where those are asked for, and the slow twin.
void bench_plant(const BenchOptions& options, recording::Json& json) {
  for (const char* name : {"hls", "rtl"}) {
    if (std::find(options.engines.begin(), options.engines.end(), name) == options.engines.end()) continue;
    const auto speeds = closed_loop_speed(name, options.seconds / options.repetitions, options.repetitions);
    const double median = speeds[speeds.size() / 2];
    json["closed_loop"][name] = {
        {"median_times_real_time", median}, {"lowest", speeds.front()}, {"highest", speeds.back()}};
    if (options.json) continue;
    fmt::print("{:<9} closed loop with the plant: {:.3g} x real time  ({:.3g} to {:.3g})\n", name, median,
               speeds.front(), speeds.back());
    std::fflush(stdout);
  }
  const auto ms = slow_twin_ms(options.repetitions);
  json["slow_twin_5h_ms"] = {{"median", ms[ms.size() / 2]}, {"lowest", ms.front()}, {"highest", ms.back()}};
  if (!options.json) {
    fmt::print("slow twin, 5 h of 1 Hz telemetry: {:.2f} ms  ({:.2f} to {:.2f})\n", ms[ms.size() / 2],
               ms.front(), ms.back());
  }
}

int bench(const BenchOptions& options) {
  const auto pairs = tone(200000);
  std::vector<Result> results;
  for (const auto& name : options.engines) {
    const auto engine = name == "sc_fixed" ? tb::make_sc_fixed_engine() : make_engine(name, false);
    results.push_back(measure(*engine, pairs, options));
    const Result& r = results.back();
    if (!options.json) {
      fmt::print("{:<9} {:>14.0f} sample pairs/s  ({:.0f} to {:.0f}), {:.3g} x real time\n", r.engine,
                 r.median(), r.pairs_per_s.front(), r.pairs_per_s.back(),
                 r.median() / config::Reference::adc_rate_hz);
      std::fflush(stdout);
    }
  }
  const auto find = [&](const char* name) {
    return std::find_if(results.begin(), results.end(), [&](const Result& r) { return r.engine == name; });
  };
  const auto hls = find("hls"), sc = find("sc_fixed");
  const bool ratio = hls != results.end() && sc != results.end();
  recording::Json json;
  bench_plant(options, json);
  if (options.json) {
    for (const Result& r : results) {
      json["engines"][r.engine] = {{"median_pairs_per_s", r.median()},
                                   {"lowest", r.pairs_per_s.front()},
                                   {"highest", r.pairs_per_s.back()}};
    }
    if (ratio) json["hls_over_sc_fixed"] = hls->median() / sc->median();
    fmt::print("{}\n", recording::json_text(json, 2));
  } else if (ratio) {
    fmt::print("hls is {:.0f} times as fast as the same chain on sc_fixed\n", hls->median() / sc->median());
  }
  return exit_good;
}

}  // namespace

void add_bench(CLI::App& app, Job& job) {
  auto options = std::make_shared<BenchOptions>();
  options->engines = engine_names();
  options->engines.push_back("sc_fixed");
  auto* command = app.add_subcommand(
      "bench", "Speed of each engine and of the simulations, reference instrument, one core");
  command->add_option("--seconds", options->seconds, "time for each engine [s]")
      ->check(number_between(0.05, 600.0))
      ->capture_default_str();
  command
      ->add_option("--repetitions", options->repetitions,
                   "timed pieces; median, lowest and highest are printed")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command
      ->add_option("-e,--engines", options->engines,
                   "which; sc_fixed is the hls core on SystemC's fixed-point type")
      ->delimiter(',')
      ->check(CLI::IsMember(options->engines))
      ->capture_default_str();
  command->add_flag("--json", options->json, "as JSON");
  command->footer("Example: hemi bench --seconds 5 --engines hls,rtl,sc_fixed");
  command->callback([options, &job] { job = [options] { return bench(*options); }; });
}

}  // namespace hemi::cli

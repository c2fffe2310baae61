// SPDX-License-Identifier: Apache-2.0
// Recordings of the settled instrument at rest, and their Allan deviation beside the noise budget's.
#ifndef HEMI_TESTS_TB_NOISE_BENCH_HPP
#define HEMI_TESTS_TB_NOISE_BENCH_HPP

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "golden/calibration/allan.hpp"
#include "golden/loops/noise_budget.hpp"
#include "tests/tb/control_bench.hpp"

namespace hemi::tests {

inline constexpr double kSettling_s = 30.0;

struct NoiseRecording {
  Eigen::VectorXd rate_dph;
  Eigen::VectorXd frequency_hz;
};

/// Runs on and keeps rate and frequency. Throws if a status bit says that the instrument was not in
/// operation.
inline NoiseRecording record_noise(ControlBench& bench, double seconds) {
  NoiseRecording recording;
  const auto count = static_cast<Eigen::Index>(seconds * config::output_rate_hz);
  recording.rate_dph.resize(count);
  recording.frequency_hz.resize(count);
  Eigen::Index filled = 0;
  while (filled < count) {
    const double left_s = static_cast<double>(count - filled) / config::output_rate_hz;
    for (const Reading& r : bench.run(std::min(left_s, 10.0))) {
      if (r.live != 0) throw std::runtime_error("noise recording: the instrument is not in operation");
      recording.rate_dph[filled] = r.rate_dph;
      recording.frequency_hz[filled++] = r.frequency_hz;
    }
  }
  return recording;
}

/// The nominal instrument at rest at 20 degC, started at its working amplitude and settled.
inline ControlBench settled_bench(std::unique_ptr<tb::Engine> engine, const physics::Instrument& instrument,
                                  bool wide, std::uint64_t seed) {
  ControlBench bench(std::move(engine), instrument, wide, {1.0, 2.0, 0.0, 0.0}, seed);
  bench.run(kSettling_s);
  return bench;
}

inline loops::NoiseBudget noise_budget(const physics::Instrument& instrument, bool wide) {
  return {instrument, sampling(wide), wide ? config::Wide::adc_bits : config::Reference::adc_bits};
}

/// One row of the comparison. sigma: of the estimator, relative, from its equivalent degrees of freedom for
/// white noise over all recordings together.
struct AllanRow {
  double tau_s;
  double predicted;
  double measured;
  double sigma;
  double ratio() const { return measured / predicted; }
};

/// Allan deviation over several recordings of equal length (mean of variances) for 2, 4, 8, ... records.
template <class PredictedVariance>
std::vector<AllanRow> allan_rows(const std::vector<const Eigen::VectorXd*>& recordings, double longest_tau_s,
                                 const PredictedVariance& predicted) {
  std::vector<AllanRow> rows;
  std::vector<std::vector<calibration::AllanPoint>> points;
  for (const auto* r : recordings)
    points.push_back(calibration::allan_deviation(*r, 1.0 / config::output_rate_hz).points);
  for (std::size_t i = 1; i < points[0].size() && points[0][i].tau_s <= longest_tau_s; ++i) {
    double variance = 0.0, freedom = 0.0;
    for (const auto& p : points) {
      variance += p[i].deviation * p[i].deviation / static_cast<double>(points.size());
      freedom += p[i].degrees_of_freedom;
    }
    const auto& first = points[0][i];
    rows.push_back(
        {first.tau_s, std::sqrt(predicted(first.averaged)), std::sqrt(variance), std::sqrt(0.5 / freedom)});
  }
  return rows;
}

inline std::vector<AllanRow> rate_rows(const std::vector<NoiseRecording>& recordings, double longest_tau_s,
                                       const loops::NoiseBudget& budget) {
  std::vector<const Eigen::VectorXd*> rates;
  for (const auto& r : recordings) rates.push_back(&r.rate_dph);
  return allan_rows(rates, longest_tau_s, [&](long m) { return budget.rate_allan_variance(m).total(); });
}

inline std::vector<AllanRow> frequency_rows(const std::vector<NoiseRecording>& recordings,
                                            double longest_tau_s, const loops::NoiseBudget& budget) {
  std::vector<const Eigen::VectorXd*> frequencies;
  for (const auto& r : recordings) frequencies.push_back(&r.frequency_hz);
  return allan_rows(frequencies, longest_tau_s,
                    [&](long m) { return budget.frequency_allan_variance(m).total(); });
}

inline void print_rows(const char* title, const std::vector<AllanRow>& rows) {
  std::printf("%s\n   tau [s]   predicted    measured   ratio   sigma of the estimate\n", title);
  for (const auto& r : rows)
    std::printf("%10.3f  %10.4g  %10.4g  %6.3f  %5.1f %%\n", r.tau_s, r.predicted, r.measured, r.ratio(),
                100.0 * r.sigma);
}

}  // namespace hemi::tests

#endif  // HEMI_TESTS_TB_NOISE_BENCH_HPP

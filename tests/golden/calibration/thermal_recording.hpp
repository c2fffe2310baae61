// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "golden/calibration/bias_regression.hpp"

namespace hemi::calibration::testing {

/// Chamber runs of 20 000 s: one cooling from room to -20 degC, or -20, then 40, then 10 degC.
enum class Profile { kCooling, kCycle };

inline constexpr double kReferenceHz = 4424.9;

/// Frequency and slope of a resonator behind a first-order lag of 2600 s in a chamber that moves at 2
/// degC/min.
inline DriftSamples thermal_recording(int rows, Profile profile) {
  DriftSamples samples;
  samples.frequency_hz.resize(rows);
  samples.slope_hz_per_s.resize(rows);
  samples.rate_dph = Eigen::VectorXd::Zero(rows);
  samples.segments = {{0, rows}};
  const double step_s = 20000.0 / rows;
  double chamber = 22.0;
  double t = 22.0;
  for (int i = 0; i < rows; ++i) {
    const double time_s = i * step_s;
    const double cycle_target = time_s < 7000.0 ? -20.0 : (time_s < 14000.0 ? 40.0 : 10.0);
    const double target = profile == Profile::kCooling ? -20.0 : cycle_target;
    chamber += std::clamp(target - chamber, -step_s / 30.0, step_s / 30.0);
    t += (1.0 - std::exp(-step_s / 2600.0)) * (chamber - t);
    samples.frequency_hz(i) = 4424.90095 + t * (0.371555556 + t * (-9.70238095e-4 + t * 1.52777778e-5));
    samples.slope_hz_per_s(i) =
        (0.371555556 + t * (-2.0 * 9.70238095e-4 + t * 3.0 * 1.52777778e-5)) * (chamber - t) / 2600.0;
  }
  return samples;
}

using Truth = std::array<double, kDriftTermCount>;

/// Coefficients such that each named term reaches its share of `size_dph` somewhere in the recording.
inline Truth scaled_truth(const DriftSamples& samples,
                          const std::vector<std::pair<std::size_t, double>>& shares, double size_dph) {
  const double largest_f = (samples.frequency_hz.array() - kReferenceHz).abs().maxCoeff();
  const double largest_df = samples.slope_hz_per_s.cwiseAbs().maxCoeff();
  Truth truth{};
  truth[0] = 2.0;
  for (const auto& [term, share] : shares) {
    truth[term] = share * size_dph / kDriftTerms[term].value(largest_f, largest_df);
  }
  return truth;
}

/// Drift plus stationary noise of unit variance and the given lag-1 correlation.
inline void fill_rate(DriftSamples& samples, const Truth& truth, double correlation,
                      std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  double noise = normal(generator);
  for (Eigen::Index i = 0; i < samples.rate_dph.size(); ++i) {
    double rate = noise;
    for (std::size_t k = 0; k < kDriftTermCount; ++k) {
      rate +=
          truth[k] * kDriftTerms[k].value(samples.frequency_hz(i) - kReferenceHz, samples.slope_hz_per_s(i));
    }
    samples.rate_dph(i) = rate;
    noise = correlation * noise + std::sqrt(1.0 - correlation * correlation) * normal(generator);
  }
}

}  // namespace hemi::calibration::testing

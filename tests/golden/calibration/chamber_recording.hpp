// SPDX-License-Identifier: Apache-2.0
// Chamber recordings with a known truth: the nominal simulation of the formats, written here once more and in
// continuous time, with noise on every channel.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "golden/calibration/drift_terms.hpp"
#include "golden/calibration/thermal_filter.hpp"

namespace hemi::calibration::testing {

struct Instrument {
  std::vector<double> coefficients_hz = {4424.90095, 0.371555556, -9.70238095e-4, 1.52777778e-5};
  double time_constant_s = 2600.0;
  double case_pole_s = 600.0;
  double reference_hz = 4432.07;
  std::array<double, kDriftTermCount> bias_dph = {2.0, -0.31, 0.004, 0.0, 850.0, 0.0, 0.0, 20.0, 0.0, 0.0};
  double scale_factor = 1.0;
  double frequency_hz_rthz = 2e-5;  ///< one-sided; per sample at interval d: density / sqrt(2 d)
  double rate_dph_rthz = 0.6;
  double case_noise_degc = 0.01;
  double case_step_degc = 0.01;
  /// Coloured noise beside the white one: standard deviation, correlation time.
  double frequency_colour_hz = 0.0;
  double rate_colour_dph = 0.0;
  double colour_s = 200.0;
};

/// Chamber target from a time on; the chamber moves at 2 degC/min.
using Targets = std::vector<std::pair<double, double>>;

/// Seven soaks of `soak_s` from -20 to 40 degC, from room temperature.
inline Targets seven_soaks(double soak_s = 4.5 * 3600.0) {
  Targets profile;
  for (int i = 0; i < 7; ++i) profile.emplace_back(soak_s * i, -20.0 + 10.0 * i);
  return profile;
}

struct ChamberRecording {
  std::vector<double> time_s, case_degc, frequency_hz, rate_dph, resonator_degc, slope_hz_per_s;
  ThermalStretch stretch() const {
    const auto n = static_cast<Eigen::Index>(time_s.size());
    return {Eigen::VectorXd::Map(time_s.data(), n), Eigen::VectorXd::Map(case_degc.data(), n),
            Eigen::VectorXd::Map(frequency_hz.data(), n)};
  }
};

/// First-order correlated noise of a standard deviation and a correlation time.
class Coloured {
 public:
  Coloured(double deviation, double correlation_s, double step_s)
      : keep_(std::exp(-step_s / correlation_s)), deviation_(deviation) {}
  template <class Generator>
  double next(Generator& generator) {
    const double fresh = deviation_ * normal_(generator);
    value_ = first_ ? fresh : keep_ * value_ + std::sqrt(1.0 - keep_ * keep_) * fresh;
    first_ = false;
    return value_;
  }

 private:
  double keep_, deviation_, value_ = 0.0;
  bool first_ = true;
  std::normal_distribution<double> normal_;
};

inline ChamberRecording chamber_recording(const Instrument& instrument, const Targets& profile,
                                          double duration_s, std::uint64_t seed, double step_s = 1.0,
                                          double room_degc = 23.0) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Coloured frequency_colour(instrument.frequency_colour_hz, instrument.colour_s, step_s);
  Coloured rate_colour(instrument.rate_colour_dph, instrument.colour_s, step_s);
  ChamberRecording r;
  double chamber = room_degc, housing = room_degc, resonator = room_degc;
  const double tau = instrument.time_constant_s, pole = instrument.case_pole_s;
  const double white_hz = instrument.frequency_hz_rthz / std::sqrt(2.0 * step_s);
  const double white_dph = instrument.rate_dph_rthz / std::sqrt(2.0 * step_s);
  const auto& c = instrument.coefficients_hz;
  std::size_t leg = 0;
  const auto rows = static_cast<std::size_t>(duration_s / step_s);
  for (std::size_t i = 0; i < rows; ++i) {
    const double time_s = step_s * static_cast<double>(i);
    while (leg + 1 < profile.size() && profile[leg + 1].first <= time_s) ++leg;
    double f = 0.0, per_degc = 0.0;
    for (std::size_t k = c.size(); k-- > 0;) {
      per_degc = per_degc * resonator + f;
      f = f * resonator + c[k];
    }
    const double slope = per_degc * (housing - resonator) / tau;
    double rate = white_dph * normal(generator) + rate_colour.next(generator);
    for (std::size_t k = 0; k < kDriftTermCount; ++k)
      rate += instrument.bias_dph[k] * kDriftTerms[k].value(f - instrument.reference_hz, slope);
    const double reading = housing + instrument.case_noise_degc * normal(generator);
    r.time_s.push_back(time_s);
    r.case_degc.push_back(instrument.case_step_degc > 0.0
                              ? std::round(reading / instrument.case_step_degc) * instrument.case_step_degc
                              : reading);
    r.frequency_hz.push_back(f + white_hz * normal(generator) + frequency_colour.next(generator));
    r.rate_dph.push_back(rate);
    r.resonator_degc.push_back(resonator);
    r.slope_hz_per_s.push_back(slope);
    // Exact over a step in which the chamber moves straight: both poles in closed form for a ramp's mean.
    const double move = std::clamp(profile[leg].second - chamber, -step_s / 30.0, step_s / 30.0);
    const double before = housing;
    housing += (1.0 - std::exp(-step_s / pole)) * (chamber + 0.5 * move - housing);
    chamber += move;
    resonator += (1.0 - std::exp(-step_s / tau)) * (0.5 * (before + housing) - resonator);
  }
  return r;
}

}  // namespace hemi::calibration::testing

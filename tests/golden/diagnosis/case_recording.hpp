// SPDX-License-Identifier: Apache-2.0
// Recordings of temperature and rate, written with forms of the effects that the diagnosis does not use:
// nodes by explicit Euler in small steps, hysteresis by Preisach relays.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "golden/diagnosis/memory_columns.hpp"

namespace hemi::diagnosis {

inline constexpr double kStep_s = 10.0;

// Straight lines between corners (time [s], temperature [degC]), and a thermometer's noise of 0.01 degC.
inline CaseRows chamber(const std::vector<std::pair<double, double>>& corners, unsigned seed) {
  std::vector<double> time, degc;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::size_t at = 0;
  for (double t = 0.0; t <= corners.back().first; t += kStep_s) {
    while (at + 2 < corners.size() && t > corners[at + 1].first) ++at;
    const auto& [t0, from] = corners[at];
    const auto& [t1, to] = corners[at + 1];
    time.push_back(t);
    degc.push_back(from + (to - from) * (t - t0) / (t1 - t0) + noise(random));
  }
  const auto n = static_cast<Eigen::Index>(time.size());
  return {Eigen::VectorXd::Map(time.data(), n), Eigen::VectorXd::Map(degc.data(), n),
          Eigen::VectorXd::Zero(n)};
}

inline CaseRows one_ramp(unsigned seed) {
  return chamber({{0, -20}, {24000, 60}}, seed);
}

// Three cycles, each at another speed, with a hold between.
inline CaseRows three_speeds(unsigned seed) {
  return chamber({{0, 25},
                  {3000, -20},
                  {6000, -20},
                  {12000, 60},
                  {13500, 60},
                  {15500, -20},
                  {17000, -20},
                  {20000, 60},
                  {21500, 60},
                  {33000, -20},
                  {36000, 20}},
                 seed);
}

// 20 deg/h of cubic; noise of `red` deg/h with a correlation over 300 s, and white of 1 deg/h.
inline void add_baseline(CaseRows& rows, double red, unsigned seed) {
  std::mt19937_64 random(seed + 1000);
  std::normal_distribution<double> normal;
  const double pole = std::exp(-kStep_s / 300.0);
  double state = normal(random);
  for (Eigen::Index i = 0; i < rows.rate_dph.size(); ++i) {
    const double u = (rows.case_degc[i] - 20.0) / 40.0;
    rows.rate_dph[i] += 5.0 - 10.0 * u + 4.0 * u * u + 3.0 * u * u * u + red * state + normal(random);
    state = pole * state + std::sqrt(1.0 - pole * pole) * normal(random);
  }
}

inline void add_lag(CaseRows& rows, double gain_dph_per_degc, double tau_s) {
  double node = rows.case_degc[0];
  for (Eigen::Index i = 0; i < rows.rate_dph.size(); ++i) {
    for (int k = 0; k < 20; ++k) node += kStep_s / 20.0 / tau_s * (rows.case_degc[i] - node);
    rows.rate_dph[i] += gain_dph_per_degc * (rows.case_degc[i] - node);
  }
}

// Relays that switch up at centre + half width and down at centre - half width, on a grid of both.
inline void add_hysteresis(CaseRows& rows, double height_dph) {
  struct Relay {
    double up, down, state;
  };
  std::vector<Relay> relays;
  for (double centre = -15.0; centre <= 55.0; centre += 2.5)
    for (double half = 4.0; half <= 12.0; half += 2.0)
      relays.push_back({centre + half, centre - half, centre < rows.case_degc[0] ? 1.0 : -1.0});
  for (Eigen::Index i = 0; i < rows.rate_dph.size(); ++i) {
    double sum = 0.0;
    for (Relay& relay : relays) {
      if (rows.case_degc[i] >= relay.up) relay.state = 1.0;
      if (rows.case_degc[i] <= relay.down) relay.state = -1.0;
      sum += relay.state;
    }
    rows.rate_dph[i] += height_dph * sum / static_cast<double>(relays.size());
  }
}

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "golden/calibration/thermal_filter.hpp"

namespace hemi::calibration {

/// A stretch of time over which the case's temperature holds.
struct Hold {
  std::size_t stretch;
  Eigen::Index begin;  ///< first row of the stretch
  Eigen::Index count;
  double case_degc;  ///< mean over the later half, where the chamber's approach is over
  double
      case_error_degc;  ///< standard error of that mean: noise, and the step of a thermometer without dither
  double from_s;
  double to_s;
};

/// A stretch of time that looks like a hold and is not used.
struct RefusedHold {
  std::size_t stretch;
  double from_s;
  double to_s;
  double case_degc;
  std::string why;
};

struct HoldOptions {
  double width_degc = 0.2;        ///< largest minus smallest of 30 s means inside a hold
  double loose_width_degc = 1.0;  ///< up to here a stretch is worth a word why it is none
  double least_s = 1200.0;        ///< shortest hold; from half of it on, too short ones are named
};

struct Holds {
  std::vector<Hold> used;
  std::vector<RefusedHold> refused;
};

/// The longest stretches in which 30 s means of the case temperature stay within a width, found one after
/// another, in order of time.
Holds find_holds(const std::vector<ThermalStretch>& stretches, const HoldOptions& options = {});

/// Step of the thermometer's numbers: the smallest difference of neighbouring readings; 0 where none differ.
double reading_step(const Eigen::VectorXd& readings);

/// Standard deviation of the readings about a slow course: sqrt(mean((x[i] - x[i-1])^2) / 2).
double reading_noise(const Eigen::VectorXd& readings);

/// Error (rms over where the value lies between two steps) of the mean of many readings with step q and noise
/// s before rounding: q / (pi sqrt 2) exp(-2 (pi s / q)^2), at most q / sqrt 12. Source: Widrow and Kollar,
/// Quantization Noise, chapter 19 (dither).
double rounding_of_the_mean(double step, double noise);

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace hemi::recording {

/// "label  42 %, 1:07 left" for a fraction done in [0, 1] after elapsed_s > 0 seconds, assuming constant
/// speed.
std::string progress_line(std::string_view label, double fraction, double elapsed_s);

/// Seconds of a steady clock.
double steady_seconds();

/// Progress on one line of a terminal: silent for the first two seconds and wherever the descriptor is no
/// terminal; the line is wiped when the object goes. `total` in the units of update(), > 0.
class Progress {
 public:
  Progress(std::string label, double total, int descriptor = 2,
           std::function<double()> clock_s = steady_seconds);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` of `total`; writes at most ten times a second.
  void update(double done);

 private:
  std::string label_;
  double total_;
  int descriptor_;
  bool terminal_;
  std::function<double()> clock_s_;
  double start_s_;
  double last_s_;
  bool shown_ = false;
};

}  // namespace hemi::recording

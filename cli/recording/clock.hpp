// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cli/recording/recording.hpp"
#include "cli/recording/table.hpp"

namespace hemi::recording {

/// What a time channel says about sampling.
struct Clock {
  double rate_hz = 0.0;  ///< (rows - 1 + missing) / span; 0 where there is but one row
  std::vector<Gap> gaps{};
  std::size_t short_steps = 0;  ///< steps below half the nominal one
};

/// Checks time_s of a table: InputError at the first value that is missing, repeated or goes backwards.
/// The nominal step is the median, which neither gaps nor jitter move.
Clock examine_clock(const Table& table, const std::vector<double>& time_s);

/// Row i at i / rate_hz.
std::vector<double> time_from_rate(std::size_t rows, double rate_hz);

/// sample_rate_hz (> 0) of an object of the sidecar, 0 where absent; InputError for anything else.
double stated_rate(const Json& object, const std::string& path, const std::string& context = "");

}  // namespace hemi::recording

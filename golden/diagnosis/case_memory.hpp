// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "golden/diagnosis/bench_diagnosis.hpp"
#include "golden/diagnosis/block_statistics.hpp"
#include "golden/diagnosis/nested_selection.hpp"

namespace hemi::diagnosis {

/// A family's error on blocks left out beside that of the best family.
struct FamilyReport {
  MemoryFamily family;
  Gain over_polynomial;  ///< polynomial to this one
  Gain to_best;          ///< this one to the best
  bool beaten = false;   ///< the 95 % interval of to_best lies above zero
};

struct MemoryParameter {
  std::string name, unit;
  double value, half_width95;
};

/// An effect that the recording shows, or may show.
struct FoundMemory {
  Memory memory;
  double probability;  ///< share of block resamples in which the best family beats all that lack it
  double score_gap;    ///< ln(held-out rms of the best family without it / of the best with it)
  std::vector<MemoryParameter> parameters;  ///< the strength first, where the effect has a linear one
  /// The parts of the recording agree that the strength is not zero.
  bool strength_certain() const {
    return !parameters.empty() && std::abs(parameters.front().value) > parameters.front().half_width95;
  }
};

struct MemoryLimit {
  Memory memory;
  std::vector<MemoryParameter> smallest;  ///< first the strength, then what it was computed for
};

struct CaseMemory {
  Verdict verdict = Verdict::consistent;
  NestedSelection selection;
  std::vector<FamilyReport> families;
  MemoryFamily best = MemoryFamily::polynomial;  ///< least held-out error
  std::vector<FoundMemory> named;                ///< held by every family that is not beaten
  std::vector<FoundMemory> open;                 ///< held by some of them
  Gain train;                                    ///< polynomial to the family chosen on all rows [deg/h]
  Gain held_out;                      ///< polynomial to the chosen ones, all chosen inside the folds [deg/h]
  double floor_rms_dph = 0.0;         ///< noise of a row, from differences of neighbours
  double both_ways = 0.0;             ///< share of the temperatures that are passed rising and falling
  double white_p = 1.0;               ///< Ljung and Box on averages of the rows
  std::vector<double> decoy_rms_dph;  ///< held-out error with a memory of a temperature that never was
  std::size_t decoys_accepted = 0;    ///< of them, those that the best family does not beat
  std::vector<MemoryLimit> limits;
};

inline constexpr Eigen::Index kMemoryFolds = 8;
/// Below this share of temperatures passed both ways the recording counts as one ramp and names nothing.
inline constexpr double kBothWaysNeeded = 0.1;

/// Says whether the rate depends on more than the case's momentary temperature, and on what: the speed of its
/// changes (thermal lag), their direction (hysteresis), or time. docs/mems.md describes it. Rows:
/// at least 256. Throws std::invalid_argument as memory_columns does; `tick` may throw.
CaseMemory diagnose_case(
    const CaseRows& rows, const std::function<void()>& tick = [] {});

/// Share of the range of temperature, in fifty parts, that is passed rising and falling.
double share_both_ways(const CaseRows& rows);

}  // namespace hemi::diagnosis

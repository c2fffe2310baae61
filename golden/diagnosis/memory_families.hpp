// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace hemi::diagnosis {

/// What a rate may remember of the temperature beside a polynomial in it.
enum class Memory { lag, two_poles, hysteresis, drift };
inline constexpr Memory kMemories[] = {Memory::lag, Memory::two_poles, Memory::hysteresis, Memory::drift};

/// Catalogue id of the effect, and the equation in words.
std::string_view effect_id(Memory memory);
std::string_view equation(Memory memory);

/// A set of models that are chosen from by cross-validation.
enum class MemoryFamily {
  polynomial,
  lag,
  two_poles,
  hysteresis,
  drift,
  lag_hysteresis,
  lag_drift,
  hysteresis_drift
};
inline constexpr MemoryFamily kMemoryFamilies[] = {MemoryFamily::polynomial, MemoryFamily::lag,
                                                   MemoryFamily::two_poles,  MemoryFamily::hysteresis,
                                                   MemoryFamily::drift,      MemoryFamily::lag_hysteresis,
                                                   MemoryFamily::lag_drift,  MemoryFamily::hysteresis_drift};
std::string_view name(MemoryFamily family);
bool holds(MemoryFamily family, Memory memory);
int effects_in(MemoryFamily family);

/// One model: ridge regression on some of the MemoryColumns.
struct MemoryForm {
  MemoryFamily family = MemoryFamily::polynomial;
  std::vector<Eigen::Index> columns;
  Eigen::VectorXd penalty;  ///< one a column, times the rows of the fit; 0 for the constant
  std::size_t past = 0;     ///< which assumption about the time before the first row
};

/// Every form of a family: degree of the polynomial, number of nodes, plays or drifts, strength of the ridge.
/// Drift and polynomial do not depend on the past and are given for past 0 alone.
std::vector<MemoryForm> memory_forms(MemoryFamily family, std::size_t past);

}  // namespace hemi::diagnosis

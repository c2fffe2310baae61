// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>
#include <set>
#include <vector>

namespace hemi::physics {

/// `count` different positions out of first .. end - 1, ascending; all of them where there are not more.
inline std::vector<std::size_t> distinct_positions(std::size_t first, std::size_t end, std::size_t count,
                                                   std::mt19937_64& random) {
  std::set<std::size_t> chosen;
  const std::size_t available = end > first ? end - first : 0;
  // Floyd's algorithm: one draw for each position, none rejected.
  for (std::size_t top = available - (count < available ? count : available); top < available; ++top) {
    const std::size_t candidate = random() % (top + 1);
    chosen.insert(first + (chosen.count(first + candidate) ? top : candidate));
  }
  return {chosen.begin(), chosen.end()};
}

}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
// Status bits that a run must have reached.
#ifndef HEMI_TESTS_RTL_BITS_HPP
#define HEMI_TESTS_RTL_BITS_HPP

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "tb/engine.hpp"

namespace hemi::tests {

inline int decimation(bool wide) {
  return wide ? config::Wide::decimation : config::Reference::decimation;
}

inline std::uint64_t bits_seen(const std::vector<tb::Record>& records) {
  std::uint64_t seen = 0;
  for (const tb::Record& record : records)
    seen |= static_cast<std::uint64_t>(record.words[config::word_status]);
  return seen;
}

inline void expect_bits(std::uint64_t seen, std::initializer_list<config::StatusBit> bits) {
  for (const auto bit : bits) EXPECT_TRUE((seen >> bit) & 1) << config::status_names[bit];
}

}  // namespace hemi::tests

#endif  // HEMI_TESTS_RTL_BITS_HPP

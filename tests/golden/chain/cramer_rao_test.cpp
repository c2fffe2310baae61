// SPDX-License-Identifier: Apache-2.0
// A selection that takes seconds; the whole grid is in cramer_rao_nightly_test.cpp.
#include <gtest/gtest.h>

#include "tests/golden/chain/cramer_rao.hpp"

namespace hemi::golden::testing {
namespace {

// 300 pieces know a standard deviation to 4 %: the limit of 12 % is three of these away from the bound.
constexpr int kPieces = 300;

TEST(CramerRao, Reference) {
  expect_efficient({InstrumentParameters::reference(), 4425.0, 60.0, kPieces, 1});
  expect_efficient({InstrumentParameters::reference(), 4365.0, 75.0, kPieces, 2});
  expect_efficient({InstrumentParameters::reference(), 4485.0, 90.0, kPieces, 3});
}

TEST(CramerRao, WideWhereSpursFoldOntoTheCarrier) {
  expect_efficient({InstrumentParameters::wide(), 250000.0 / 57.0 + 0.003, 90.0, kPieces, 4});
}

}  // namespace
}  // namespace hemi::golden::testing

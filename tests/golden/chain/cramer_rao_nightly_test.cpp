// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/golden/chain/cramer_rao.hpp"

namespace hemi::golden::testing {
namespace {

// 600 pieces know a standard deviation to 2.9 %, a mean at 60 dB to 0.07 uHz.
constexpr int kPieces = 600;

struct Grid : ::testing::TestWithParam<double> {};

TEST_P(Grid, Reference) {
  for (const double frequency : {4425.0, 4365.0, 4485.0}) {
    expect_efficient({InstrumentParameters::reference(), frequency, GetParam(), kPieces, 21});
  }
}

TEST_P(Grid, Wide) {
  for (const double frequency : {4425.0, 4365.0, 4485.0}) {
    expect_efficient({InstrumentParameters::wide(), frequency, GetParam(), kPieces, 22});
  }
}

TEST_P(Grid, WideWhereSpursFoldOntoTheCarrier) {
  for (const double frequency : {250000.0 / 57.0 + 0.003, 250000.0 / 56.0 + 0.003}) {
    expect_efficient({InstrumentParameters::wide(), frequency, GetParam(), kPieces, 23});
  }
}

INSTANTIATE_TEST_SUITE_P(CramerRao, Grid, ::testing::Values(60.0, 75.0, 90.0));

}  // namespace
}  // namespace hemi::golden::testing

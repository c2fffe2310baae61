// SPDX-License-Identifier: Apache-2.0
#include "tests/tb/acquisition.hpp"

namespace {
TEST(StartUp, AcquiresAThousandRingingResonatorsWithinTenSeconds) {
  hemi::tests::acquire(1000, 12);
}
}  // namespace

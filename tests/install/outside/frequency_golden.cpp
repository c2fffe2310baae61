// SPDX-License-Identifier: Apache-2.0
// The same by the double-precision model with the core's quantisers.
#include <cmath>
#include <cstdio>

#include "golden/chain/chain.hpp"
#include "registers.h"

int main() {
  hemi::golden::RegisterValues values;
  for (int i = 0; i < HEMI_REGISTER_COUNT; ++i)
    values[i] = std::ldexp(hemi_register_image[i], -hemi::config::registers[i].format.fraction);
  hemi::golden::Chain chain(hemi::golden::Precision::quantised,
                            hemi::golden::InstrumentParameters::reference(), values);
  std::vector<hemi::golden::ChainRecord> records;
  for (int x, y; std::scanf("%d,%d", &x, &y) == 2;) chain.step(x, y, false, records);
  for (const auto& record : records) std::printf("%.17g\n", record.words[hemi::config::word_frequency]);
}

// SPDX-License-Identifier: Apache-2.0
// Sample pairs "x,y" in, frequencies [Hz] out, by the registers of
//   hemi export my.model.json --open-loop --format c -o registers.h
#include <cmath>
#include <cstdio>

#include "hls/core.hpp"
#include "registers.h"

int main() {
  hemi::hls::Core<hemi::config::Reference> core;
  core.reset(hemi_register_image);
  hemi::hls::NoProbe probe;
  hemi::hls::Record record;
  for (int x, y; std::scanf("%d,%d", &x, &y) == 2;)
    if (core.sample(x, y, false, record, probe))
      std::printf("%.17g\n",
                  std::ldexp(record.word[hemi::config::word_frequency], -hemi::config::frequency.fraction));
}

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/golden/chain/support.hpp"

namespace hemi::golden::testing {

/// A tone at -1 dBFS in white noise, taken in by the quantised chain and cut into pieces of one second.
struct RaoCase {
  InstrumentParameters instrument;
  double frequency_hz;
  double snr_db;  ///< power of the tone over that of all noise below half the ADC rate, its rounding included
  int pieces;
  unsigned seed;
};

struct RaoResult {
  double deviation_hz;  ///< of the frequency of single pieces: least squares through the phase summed from
                        ///< 200 outputs
  double bias_hz;
  double bound_hz;   ///< Cramer-Rao, for the samples of one second
  double theory_hz;  ///< of this estimator in this chain, without rounding
};

RaoResult run_rao(const RaoCase& c);

/// Runs, prints and checks: deviation <= 1.12 bounds and as theory has it, bias <= 1 uHz.
void expect_efficient(const RaoCase& c);

}  // namespace hemi::golden::testing

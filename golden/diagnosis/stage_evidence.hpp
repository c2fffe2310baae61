// SPDX-License-Identifier: Apache-2.0
// From samples and DAC words of a capture to what the tests of its stages work on.
#pragma once

#include "golden/diagnosis/stage.hpp"

namespace hemi::diagnosis {

/// Samples between two changes of amplitude and phase in the fit of the vibration: 40 ms at the reference
/// rate.
Eigen::Index tone_piece(const StageCapture& capture);

/// First sample from which the primary stays within 2 % of its last amplitude, and 50 ms behind the last of
/// `records` that says starting or unlocked (where that is before the last 0.3 s); 0.1 s at least.
Eigen::Index settled_from(const StageCapture& capture, const std::vector<CoreWords>& records);

/// Tones of the primary and mean of the secondary from sample `from` on.
void fit_settled(const StageCapture& capture, Eigen::Index from, StageDiagnosis& diagnosis);

/// Drive's words in the rest of the primary: the word of three samples before, which stands while the sample
/// is taken.
Estimate leak_of(const StageCapture& capture, const std::vector<CoreDacs>& dacs, Eigen::Index from,
                 const ToneFit& tones);

/// Blocks of `seconds` from 5 ms on. `leaked`: drive words to be taken off the primary.
Blocks blocks_of(const StageCapture& capture, const StageNominal& nominal, const std::vector<CoreDacs>& dacs,
                 double leaked, double seconds);

}  // namespace hemi::diagnosis

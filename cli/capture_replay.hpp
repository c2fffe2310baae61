// SPDX-License-Identifier: Apache-2.0
// The hls engine as the diagnosis of captures wants it.
#ifndef HEMI_CLI_CAPTURE_REPLAY_HPP
#define HEMI_CLI_CAPTURE_REPLAY_HPP

#include <vector>

#include "golden/diagnosis/stage_core.hpp"
#include "tb/engine.hpp"

namespace hemi::cli {

/// Replays `pairs` from a reset. The pairs must outlive it.
diagnosis::Replay make_replay(const std::vector<tb::SamplePair>& pairs, bool wide);

}  // namespace hemi::cli

#endif  // HEMI_CLI_CAPTURE_REPLAY_HPP

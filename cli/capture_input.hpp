// SPDX-License-Identifier: Apache-2.0
// From the files of a capture to what the diagnosis of stages works on.
#ifndef HEMI_CLI_CAPTURE_INPUT_HPP
#define HEMI_CLI_CAPTURE_INPUT_HPP

#include <string>
#include <vector>

#include "cli/diagnose_capture.hpp"
#include "golden/diagnosis/stage.hpp"
#include "tb/engine.hpp"

namespace hemi::cli {

struct CaptureInput {
  diagnosis::StageCapture capture;
  diagnosis::StageNominal nominal;
  std::vector<tb::SamplePair> pairs;
  bool wide = false;
  std::vector<std::string> notes;
};

/// InputError (file, line, channel, remedy) for files that cannot be read or do not go together.
CaptureInput read_capture_input(const CaptureOptions& options);

}  // namespace hemi::cli

#endif  // HEMI_CLI_CAPTURE_INPUT_HPP

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace hemi::calibration {

/// A file that cannot be used. what(): `file:line: column: what is wrong; remedy`, one line.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hemi::calibration

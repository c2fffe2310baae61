// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <matio.h>

#include <memory>

namespace hemi::recording {

struct MatlabCloser {
  void operator()(mat_t* file) const { Mat_Close(file); }
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};

using MatlabFile = std::unique_ptr<mat_t, MatlabCloser>;
using MatlabVariable = std::unique_ptr<matvar_t, MatlabCloser>;

}  // namespace hemi::recording

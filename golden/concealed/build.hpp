// SPDX-License-Identifier: Apache-2.0
// A case while it is being put together; for cases.cpp alone.
#pragma once

#include <string>

#include "golden/concealed/draw.hpp"

namespace hemi::concealed {

struct Build {
  Random& random;
  Case result{};
  Stand stand{};
  Effects effects{};

  void add(const Drawn& drawn, const Detectability& limit);
};

/// Instrument and run; the model file states the instrument's true numbers.
void set_up(Build& build, const std::string& program, unsigned stimuli, bool board_is_resonator = false,
            double case_step_degc = 0.0);

/// d' of all effects together, and where the misfit lies.
void measure(Build& build, const Detectability& limit);

/// Noise, rounding, and the rows that a power cut leaves out.
void write(Build& build);

}  // namespace hemi::concealed

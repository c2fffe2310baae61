// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TB_SYSTEMC_ENGINE_HPP
#define HEMI_TB_SYSTEMC_ENGINE_HPP

#include <memory>

#include "tb/engine.hpp"
#include "tb/verilator_engine.hpp"

namespace hemi::tb {

/// The SystemC bench: the RTL, verilated into a SystemC module, and the hls core as a SystemC module beside
/// it, both on one clock and one stream of samples with random gaps and back-pressure; one scoreboard
/// compares every block's output. The records are the RTL's; std::runtime_error with the scoreboard's report
/// when the two disagree. A program has one SystemC simulation: both instruments live in it, at most one
/// engine each at a time. Leaves no waves: options.waves must be empty (std::invalid_argument).
std::unique_ptr<Engine> make_systemc_engine(bool wide, const RtlOptions& options);

}  // namespace hemi::tb

#endif  // HEMI_TB_SYSTEMC_ENGINE_HPP

// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TB_SYSTEMC_ENGINE_HPP
#define HEMI_TB_SYSTEMC_ENGINE_HPP

#include <memory>

#include "tb/engine.hpp"
#include "tb/plant_port.hpp"
#include "tb/verilator_engine.hpp"

namespace hemi::tb {

/// The engine of the SystemC bench.
class SystemcEngine : public Engine {
 public:
  /// Closes `plant` around the two cores for `samples` samples, gaps and back-pressure as in the options, and
  /// appends all records that they complete.
  virtual void closed_loop(PlantPort& plant, std::size_t samples, std::vector<Record>& output) = 0;
};

/// The SystemC bench: the RTL, verilated into a SystemC module, and the hls core as a SystemC module beside
/// it, both on one clock and one stream of samples, recorded or of a plant module that the RTL's DAC words
/// act on, with random gaps and back-pressure; scoreboards compare every block's output and the DAC words.
/// The records are the RTL's; std::runtime_error with the scoreboard's report when the two disagree. A
/// program has one SystemC simulation: both instruments live in it, at most one engine each at a time. Leaves
/// no waves: options.waves must be empty (std::invalid_argument).
std::unique_ptr<SystemcEngine> make_systemc_engine(bool wide, const RtlOptions& options);

}  // namespace hemi::tb

#endif  // HEMI_TB_SYSTEMC_ENGINE_HPP

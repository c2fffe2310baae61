// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TB_VERILATOR_ENGINE_HPP
#define HEMI_TB_VERILATOR_ENGINE_HPP

#include <cstdint>
#include <filesystem>
#include <memory>

#include "tb/engine.hpp"

namespace hemi::tb {

/// How the bench drives the RTL; the records do not depend on any of it.
struct RtlOptions {
  std::uint64_t seed = 1;                ///< of gaps and back-pressure
  double input_gap_probability = 0;      ///< that a clock passes before the next sample is offered
  double back_pressure_probability = 0;  ///< that a record word is not taken at a clock
  int clocks_per_sample = 0;             ///< least clocks from one sample to the next
  bool checks = false;  ///< stop at a read of a word that is not there yet, and at DAC words that move
                        ///< without their strobe or come later than clocks_per_sample; slower
  std::filesystem::path waves{};  ///< FST file of all signals (implies checks); empty for none
};

/// The SystemVerilog core of rtl/ under Verilator: config::Wide when `wide`, else config::Reference. Throws
/// std::runtime_error when the core stands still, and from reset() when a register does not fit
/// (FormatError).
std::unique_ptr<Engine> make_rtl_engine(bool wide, const RtlOptions& options = {});

}  // namespace hemi::tb

#endif  // HEMI_TB_VERILATOR_ENGINE_HPP

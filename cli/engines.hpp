// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_CLI_ENGINES_HPP
#define HEMI_CLI_ENGINES_HPP

#include <memory>
#include <string>
#include <vector>

#include "tb/engine.hpp"

namespace hemi::cli {

/// How engines that run a clock are exercised.
struct EngineOptions {
  unsigned seed = 1;
  double gap_probability = 0.0;            ///< of a clock without input although some is there
  double back_pressure_probability = 0.0;  ///< of a clock in which the record stream is not taken
  std::string waves;                       ///< FST file to leave, or empty
};

/// ideal, golden, hls, rtl, systemc.
const std::vector<std::string>& engine_names();

/// One sentence on each engine, in the order of engine_names().
const std::vector<std::string>& engine_meanings();

/// InputError for a name that is none of engine_names().
void check_engine_name(const std::string& name);

/// The engine of that name; checks it.
std::unique_ptr<tb::Engine> make_engine(const std::string& name, bool wide,
                                        const EngineOptions& options = {});

}  // namespace hemi::cli

#endif  // HEMI_CLI_ENGINES_HPP

// SPDX-License-Identifier: Apache-2.0
#include "cli/engines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/recording/error.hpp"
#include "tb/golden_engine.hpp"
#include "tb/hls_engine.hpp"
#include "tb/systemc_engine.hpp"
#include "tb/verilator_engine.hpp"

namespace hemi::cli {

const std::vector<std::string>& engine_names() {
  static const std::vector<std::string> names = {"ideal", "golden", "hls", "rtl", "systemc"};
  return names;
}

const std::vector<std::string>& engine_meanings() {
  static const std::vector<std::string> meanings = {
      "golden model in double precision without rounding",
      "golden model in double precision with the formats' quantisers", "fixed-point core in C++",
      "SystemVerilog under Verilator", "SystemVerilog as a SystemC module, the C++ core in step beside it"};
  return meanings;
}

void check_engine_name(const std::string& name) {
  const auto& known = engine_names();
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  throw recording::InputError({}, fmt::format("no engine '{}'", name),
                              fmt::format("use one of {}", fmt::join(known, ", ")));
}

std::unique_ptr<tb::Engine> make_engine(const std::string& name, bool wide, const EngineOptions& options) {
  check_engine_name(name);
  if (name == "ideal") return tb::make_golden_engine(wide, golden::Precision::ideal);
  if (name == "golden") return tb::make_golden_engine(wide, golden::Precision::quantised);
  if (name == "hls") return tb::make_hls_engine(wide);
  tb::RtlOptions rtl;
  rtl.seed = options.seed;
  rtl.input_gap_probability = options.gap_probability;
  rtl.back_pressure_probability = options.back_pressure_probability;
  rtl.waves = options.waves;
  if (name == "rtl") return tb::make_rtl_engine(wide, rtl);
  return tb::make_systemc_engine(wide, rtl);
}

}  // namespace hemi::cli

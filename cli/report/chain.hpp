// SPDX-License-Identifier: Apache-2.0
// The signal chain as a drawing, with the blocks that a result speaks of marked.
#ifndef HEMI_CLI_REPORT_CHAIN_HPP
#define HEMI_CLI_REPORT_CHAIN_HPP

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hemi::report {

/// A block and what is said of it: "differs first here".
struct Mark {
  std::string stage{};  ///< any name that stage_of knows
  std::string text{};
};

struct Chain {
  std::vector<Mark> marks{};
  std::string note{};
};

/// The drawing's block for a name: blocks of the core as in its taps (demodulator, cic, ...), parts of the
/// plant (resonator, thermal, electrodes, oscillator, pickoff, adc) and telemetry channels (rate_dph, ...).
/// Spaces, dashes and case do not matter. Nothing for a name that is none of them.
std::optional<std::string> stage_of(std::string_view name);

/// Two SVG drawings, one for wide and one for narrow pages; style sheets show one of them.
std::string chain_svg(const Chain& chain);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_CHAIN_HPP

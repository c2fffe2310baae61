// SPDX-License-Identifier: Apache-2.0
// Checks of options that CLI11's own ranges let through: not-a-number compares false with everything.
#ifndef HEMI_CLI_OPTIONS_HPP
#define HEMI_CLI_OPTIONS_HPP

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "cli/recording/error.hpp"

namespace hemi::cli {

/// A number from `low` to `high`, neither NaN nor infinite.
inline CLI::Validator number_between(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return {};
        return fmt::format("'{}' is no number from {:g} to {:g}", text, low, high);
      },
      fmt::format("{:g} to {:g}", low, high));
}

/// A number above zero, neither NaN nor infinite.
inline CLI::Validator positive_number() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value > 0.0 && std::isfinite(value)) return {};
        return fmt::format("'{}' is no number above zero", text);
      },
      "above 0");
}

/// InputError unless from_s < to_s; infinite ends stand for those of the recording.
inline void check_stretch(double from_s, double to_s) {
  if (from_s < to_s) return;
  throw recording::InputError({}, fmt::format("no stretch lies from {} s to {} s", from_s, to_s),
                              "give --from below --to");
}

}  // namespace hemi::cli

#endif  // HEMI_CLI_OPTIONS_HPP

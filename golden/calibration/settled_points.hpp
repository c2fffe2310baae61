// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "golden/calibration/frequency_polynomial.hpp"
#include "golden/calibration/input_error.hpp"

namespace hemi::calibration {

/// Step of a printed column: ten to the minus the largest number of decimals that any of its values shows.
/// Nothing where a value has an exponent, or where nothing is given: the text then does not show a fixed
/// step.
std::optional<double> printed_resolution(const std::vector<std::string>& values);

/// Reads settled points from a CSV file with the columns settled_degc [degC] and frequency_hz [Hz], in any
/// order and beside others. Lines that start with '#' and empty lines are skipped; the first other line names
/// the columns. The resolution is taken from the printed frequencies. order: the order that shall be fitted;
/// order + 2 points are then required. Throws InputError.
SettledPoints read_settled_points(const std::filesystem::path& path, int order = 1);

}  // namespace hemi::calibration

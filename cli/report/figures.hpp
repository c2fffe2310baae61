// SPDX-License-Identifier: Apache-2.0
// Tables that are drawings as well.
#ifndef HEMI_CLI_REPORT_FIGURES_HPP
#define HEMI_CLI_REPORT_FIGURES_HPP

#include <string>

#include "cli/report/report.hpp"

namespace hemi::report {

std::string intervals_html(const Intervals& part);

/// Cells of a row and a column of one name are framed: there the answer is the truth.
std::string matrix_html(const Matrix& part);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_FIGURES_HPP

// SPDX-License-Identifier: Apache-2.0
// A plot as it stands without a script, and on paper.
#ifndef HEMI_CLI_REPORT_PLOT_SVG_HPP
#define HEMI_CLI_REPORT_PLOT_SVG_HPP

#include <cstddef>
#include <string>

#include "cli/report/report.hpp"

namespace hemi::report {

/// What a plot's axes span: all points with their intervals, and a little more. Empty plots span 0 to 1.
struct Extent {
  double x0, x1, y0, y1;
};
Extent extent_of(const Plot& plot);

/// The whole plot. Colours, dashes and type come from the page's style sheet (classes s0, s1, ...).
std::string plot_svg(const Plot& plot, const std::string& id);

/// The sample of a curve's line and marker that stands in the legend.
std::string legend_key(std::size_t series, Style style);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_PLOT_SVG_HPP

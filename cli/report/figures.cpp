// SPDX-License-Identifier: Apache-2.0
#include "cli/report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/report/markup.hpp"
#include "cli/report/ticks.hpp"

namespace hemi::report {
namespace {

/// 200 units wide; what lies beyond the scale stands at its end.
std::string interval_svg(const Intervals& part, const Intervals::Row& row) {
  const auto at = [&](double v) {
    return 5.0 + 190.0 * std::clamp((v - part.low) / (part.high - part.low), 0.0, 1.0);
  };
  std::string svg =
      "<svg class=\"interval\" viewBox=\"0 0 200 18\" preserveAspectRatio=\"none\" "
      "aria-hidden=\"true\"><path class=\"axis\" "
      "d=\"M5 9H195M5 5V13M100 7V11M195 5V13\"/>";
  for (const double mark : row.target_marks)
    svg += fmt::format("<path class=\"target\" d=\"M{0:.1f} 1V17\"/>", at(mark));
  if (!std::isnan(row.value))
    svg += fmt::format(
        "<path class=\"span\" d=\"M{0:.1f} 9H{1:.1f}M{0:.1f} 6V12M{1:.1f} 6V12\"/><circle class=\"value\" "
        "cx=\"{2:.1f}\" cy=\"9\" r=\"3.4\"/>",
        at(row.low), at(row.high), at(row.value));
  return svg + "</svg>";
}

std::string head(const std::string& cell, const char* kind = "") {
  return fmt::format("<th scope=\"col\"{}>{}</th>", kind, escaped(cell));
}

}  // namespace

std::string intervals_html(const Intervals& part) {
  const bool targets = std::ranges::any_of(part.rows, [](const auto& row) { return !row.target.empty(); });
  std::string html = "<div class=\"table\" tabindex=\"0\"><table class=\"intervals\"><thead><tr>" +
                     head("figure") + (targets ? head("target") : std::string()) + head("n", " class=\"n\"") +
                     head("value", " class=\"n\"") + head("95 % interval") +
                     head(fmt::format("from {} to {}", nice_number(part.low), nice_number(part.high))) +
                     head("outcome");
  for (const auto& other : part.others) html += head(other);
  html += "</tr></thead><tbody>\n";
  for (const auto& row : part.rows) {
    const bool any = !std::isnan(row.value);
    html += fmt::format(
        "<tr{}><td>{}</td>{}<td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td>"
        "<td class=\"bar-cell\">{}</td><td>{}</td>",
        row.stands_out ? " class=\"stands-out\"" : "", escaped(row.name),
        targets ? "<td>" + escaped(row.target) + "</td>" : std::string(), escaped(row.count),
        any ? nice_number(row.value, 3) : "–",
        any ? nice_number(row.low, 3) + " to " + nice_number(row.high, 3) : "–", interval_svg(part, row),
        escaped(row.outcome));
    for (const auto& other : row.others) html += "<td>" + escaped(other) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string matrix_html(const Matrix& part) {
  std::string html = "<div class=\"table\" tabindex=\"0\"><table class=\"matrix\"><caption>" +
                     escaped(part.title) + "</caption><thead><tr><td></td>";
  for (const auto& column : part.columns) html += head(column);
  html += "</tr></thead><tbody>\n";
  for (std::size_t r = 0; r < part.rows.size(); ++r) {
    html += "<tr><th scope=\"row\">" + escaped(part.rows[r]) + "</th>";
    const auto& counts = part.counts[r];
    const int all = std::accumulate(counts.begin(), counts.end(), 0);
    for (std::size_t c = 0; c < counts.size(); ++c) {
      const double share = all > 0 ? 100.0 * counts[c] / all : 0.0;
      html +=
          fmt::format("<td{} style=\"background:color-mix(in srgb, var(--s0) {:.0f}%, transparent)\">{}</td>",
                      part.rows[r] == part.columns[c] ? " class=\"same\"" : "", 0.45 * share,
                      counts[c] > 0 ? fmt::format("{}", counts[c]) : "");
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace hemi::report

// SPDX-License-Identifier: Apache-2.0
#include "cli/report/plot_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cli/report/markup.hpp"
#include "cli/report/ticks.hpp"

namespace hemi::report {
namespace {

constexpr double kWidth = 960.0, kLeft = 86.0, kRight = 12.0, kTop = 10.0, kBottom = 44.0;
constexpr double kLow = 230.0, kHigh = 380.0;  // height over time, and of other plots
constexpr std::size_t kSvgBuckets = 600;
constexpr double kMarkerEvery = 120.0;  // along a line

double height_of(const Plot& plot) {
  return plot.link.empty() ? kHigh : kLow;
}

bool drawable(const Axis& axis, double value) {
  return std::isfinite(value) && (!axis.log || value > 0.0);
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  void take(const Axis& axis, double value) {
    if (!drawable(axis, value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// A margin on both sides; something around a single value.
Range widened(Range r, const Axis& axis, double share) {
  if (!(r.low <= r.high)) return axis.log ? Range{0.1, 1.0} : Range{0.0, 1.0};
  if (axis.log) {
    const double factor =
        std::max(std::pow(r.high / r.low, share), share > 0.0 || r.low == r.high ? 1.1 : 1.0);
    return {r.low / factor, r.high * factor};
  }
  double margin = share * (r.high - r.low);
  // Below a few hundred steps of the doubles themselves there is nothing to see.
  const double least = 1e-13 * std::max(std::abs(r.low), std::abs(r.high));
  if (!(r.high - r.low > least)) margin = r.low == 0.0 ? 1.0 : std::max(0.01 * std::abs(r.low), least);
  return {r.low - margin, r.high + margin};
}

/// From values to places in the drawing.
struct Scale {
  const Axis& axis;
  double low, high, from, to;
  double operator()(double value) const {
    const double share =
        axis.log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return from + share * (to - from);
  }
};

std::string marker(std::size_t shape, double x, double y) {
  switch (shape % 6) {
    case 0:
      return fmt::format("M{:.1f} {:.1f}m-3 0a3 3 0 1 0 6 0a3 3 0 1 0 -6 0z", x, y);
    case 1:
      return fmt::format("M{:.1f} {:.1f}h6v6h-6z", x - 3, y - 3);
    case 2:
      return fmt::format("M{:.1f} {:.1f}l3.6 6.4h-7.2z", x, y - 4);
    case 3:
      return fmt::format("M{:.1f} {:.1f}l4 4l-4 4l-4 -4z", x, y - 4);
    case 4:
      return fmt::format("M{:.1f} {:.1f}l3.6 -6.4h-7.2z", x, y + 4);
    default:
      return fmt::format("M{:.1f} {:.1f}h7M{:.1f} {:.1f}v7", x - 3.5, y, x, y - 3.5);
  }
}

std::string grid(const std::vector<Tick>& xs, const std::vector<Tick>& ys, const Scale& sx, const Scale& sy,
                 double height) {
  std::string lines, labels;
  for (const Tick& t : xs) {
    lines += fmt::format("M{:.1f} {:.1f}V{:.1f}", sx(t.value), kTop, height - kBottom);
    if (!t.label.empty())
      labels += fmt::format("<text class=\"x\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", sx(t.value),
                            height - kBottom + 17, t.label);
  }
  for (const Tick& t : ys) {
    lines += fmt::format("M{:.1f} {:.1f}H{:.1f}", kLeft, sy(t.value), kWidth - kRight);
    if (!t.label.empty())
      labels += fmt::format("<text class=\"y\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", kLeft - 7,
                            sy(t.value) + 4, t.label);
  }
  return "<path class=\"grid\" d=\"" + lines + "\"/>" + labels;
}

std::string shades(const Plot& plot, const Scale& sx, double height) {
  std::string svg;
  for (const Shade& s : plot.shades) {
    if (s.to < sx.low || s.from > sx.high) continue;
    const double from = std::clamp(sx(s.from), kLeft, kWidth - kRight);
    const double to = std::clamp(sx(s.to), kLeft, kWidth - kRight);
    svg += fmt::format(
        "<rect class=\"shade{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
        "height=\"{:.1f}\"><title>{}</title>"
        "</rect>",
        s.quiet ? " quiet" : "", from, kTop, std::max(1.0, to - from), height - kBottom - kTop,
        escaped(s.label));
    if (!s.label.empty() && to - from > 7.0 * static_cast<double>(s.label.size()))
      svg += fmt::format("<text class=\"shade{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                         s.quiet ? " quiet" : "", from + 5, kTop + 14, escaped(s.label));
  }
  return svg;
}

std::string curve(const Plot& plot, std::size_t index, const Scale& sx, const Scale& sy) {
  const Series& series = plot.series[index];
  const Points points = series.lower.empty() ? thinner(series.points, kSvgBuckets) : series.points;
  const bool dots = series.style == Style::kPoints;
  std::string path, marks;
  bool pen_down = false;
  // Lines carry a marker now and then, each curve at other places.
  double next_mark = kLeft + kMarkerEvery * (0.25 + 0.17 * static_cast<double>(index));
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (!drawable(plot.x, points.x[i]) || !drawable(plot.y, points.y[i])) {
      pen_down = false;
      continue;
    }
    const double x = sx(points.x[i]), y = sy(points.y[i]);
    if (!dots) path += fmt::format("{}{:.1f} {:.1f}", pen_down ? 'L' : 'M', x, y);
    pen_down = true;
    if (dots || !series.lower.empty() || (plot.series.size() > 1 && x >= next_mark)) {
      marks += marker(index, x, y);
      next_mark = std::max(next_mark + kMarkerEvery, x);
    }
  }
  std::string bars;
  for (std::size_t i = 0; i < series.lower.size(); ++i) {
    if (!drawable(plot.y, series.lower[i]) || !drawable(plot.y, series.upper[i])) continue;
    const double x = sx(points.x[i]), y0 = sy(series.lower[i]), y1 = sy(series.upper[i]);
    bars += fmt::format("M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h8M{3:.1f} {2:.1f}h8", x, y0, y1, x - 4);
  }
  std::string svg;
  const std::size_t style = index % 6;
  if (!bars.empty()) svg += fmt::format("<path class=\"bar s{}\" d=\"{}\"/>", style, bars);
  if (!path.empty()) svg += fmt::format("<path class=\"line s{}\" d=\"{}\"/>", style, path);
  if (!marks.empty()) svg += fmt::format("<path class=\"mark s{}\" d=\"{}\"/>", style, marks);
  return svg;
}

}  // namespace

Extent extent_of(const Plot& plot) {
  Range x, y;
  for (const Series& s : plot.series) {
    for (std::size_t i = 0; i < s.points.x.size(); ++i) {
      if (!drawable(plot.x, s.points.x[i])) continue;
      x.take(plot.x, s.points.x[i]);
      y.take(plot.y, s.points.y[i]);
    }
    for (std::size_t i = 0; i < s.lower.size(); ++i) {
      y.take(plot.y, s.lower[i]);
      y.take(plot.y, s.upper[i]);
    }
  }
  x = widened(x, plot.x, plot.link.empty() ? 0.02 : 0.0);
  y = widened(y, plot.y, 0.06);
  return {x.low, x.high, y.low, y.high};
}

std::string plot_svg(const Plot& plot, const std::string& id) {
  const Extent e = extent_of(plot);
  const double height = height_of(plot);
  const Scale sx{plot.x, e.x0, e.x1, kLeft, kWidth - kRight};
  const Scale sy{plot.y, e.y0, e.y1, height - kBottom, kTop};
  const auto xs = plot.x.log ? log_ticks(e.x0, e.x1) : linear_ticks(e.x0, e.x1, 8);
  const auto ys = plot.y.log ? log_ticks(e.y0, e.y1) : linear_ticks(e.y0, e.y1, plot.link.empty() ? 6 : 4);
  std::string svg = fmt::format(
      "<svg class=\"static\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\"><clipPath "
      "id=\"clip-{}\"><rect "
      "x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\"/></clipPath>",
      kWidth, height,
      escaped(fmt::format("{}: {} over {}", plot.title, with_unit(plot.y.label, plot.y.unit),
                          with_unit(plot.x.label, plot.x.unit))),
      id, kLeft, kTop, kWidth - kRight - kLeft, height - kBottom - kTop);
  svg += grid(xs, ys, sx, sy, height);
  svg += shades(plot, sx, height);
  svg += fmt::format("<g clip-path=\"url(#clip-{})\">", id);
  for (const Guide& g : plot.guides)
    svg += fmt::format("<path class=\"guide\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"><title>{}</title></path>",
                       sx(g.x0), sy(g.y0), sx(g.x1), sy(g.y1), escaped(g.name));
  for (std::size_t i = 0; i < plot.series.size(); ++i) svg += curve(plot, i, sx, sy);
  svg += "</g>";
  for (const Guide& g : plot.guides) {
    // The name stands where the line leaves the plot, to the right or below.
    const double bottom = height - kBottom - 4.0, x0 = sx(g.x0), y0 = sy(g.y0), x1 = sx(g.x1), y1 = sy(g.y1);
    const double leaves = y1 > bottom ? x0 + (bottom - y0) * (x1 - x0) / (y1 - y0) : x1;
    svg += fmt::format("<text class=\"guide\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                       std::clamp(leaves, kLeft, kWidth - kRight) - 4,
                       std::clamp(std::min(y1, bottom) - 6, kTop + 12, bottom), escaped(g.name));
  }
  svg += fmt::format("<path class=\"frame\" d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\"/>", kLeft, kTop,
                     height - kBottom, kWidth - kRight);
  svg +=
      fmt::format("<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                  0.5 * (kLeft + kWidth - kRight), height - 8, escaped(with_unit(plot.x.label, plot.x.unit)));
  svg += fmt::format("<text class=\"title\" transform=\"translate(14 {:.1f}) rotate(-90)\">{}</text>",
                     0.5 * (kTop + height - kBottom), escaped(with_unit(plot.y.label, plot.y.unit)));
  return svg + "</svg>";
}

std::string legend_key(std::size_t series, Style style) {
  std::string svg = "<svg class=\"key\" viewBox=\"0 0 34 12\" aria-hidden=\"true\">";
  if (style == Style::kLine) svg += fmt::format("<path class=\"line s{}\" d=\"M0 6H34\"/>", series % 6);
  return svg + fmt::format("<path class=\"mark s{}\" d=\"{}\"/></svg>", series % 6, marker(series, 17, 6));
}

}  // namespace hemi::report

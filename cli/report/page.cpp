// SPDX-License-Identifier: Apache-2.0
// The document as one HTML page.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>

#include "cli/recording/json.hpp"
#include "cli/report/assets.hpp"
#include "cli/report/figures.hpp"
#include "cli/report/markup.hpp"
#include "cli/report/plot_svg.hpp"
#include "cli/report/report.hpp"
#include "cli/report/ticks.hpp"

namespace hemi::report {
namespace {

using recording::Json;

// Points of all curves of a page together: 21 bytes each leave room below two megabytes.
constexpr std::size_t kPagePoints = 60000;

constexpr std::size_t every_bucket = std::numeric_limits<std::size_t>::max() / 2;

/// Where a page is while it is being written.
struct Writer {
  std::string html{};
  std::size_t buckets = kBuckets;
  int plots = 0;
};

/// A figure with or without power of ten and percent sign; "1 to 2" is text.
bool is_number(const std::string& cell) {
  const bool starts = !cell.empty() && (std::isdigit(static_cast<unsigned char>(cell[0])) != 0 ||
                                        cell[0] == '-' || cell[0] == '+' || cell.starts_with("−"));
  return starts &&
         std::ranges::none_of(cell, [](unsigned char c) { return c != 'e' && std::isalpha(c) != 0; });
}

std::string paragraph(const std::string& text, const char* kind) {
  return text.empty() ? std::string() : fmt::format("<p class=\"{}\">{}</p>\n", kind, escaped(text));
}

/// For scripts: no text in it can end the element.
std::string script_json(const Json& json) {
  std::string text = recording::json_text(json), out;
  for (const char c : text) out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

Json axis_json(const Axis& axis) {
  return {{"label", axis.label},
          {"unit", axis.unit},
          {"title", with_unit(axis.label, axis.unit)},
          {"log", axis.log}};
}

Json series_json(const Series& series, const Points& points) {
  Json json{{"name", series.name},
            {"dots", series.style == Style::kPoints},
            {"interval", points.interval},
            {"x", base64(points.x)},
            {"y", base64(points.y)}};
  if (!series.lower.empty()) {
    json["lower"] = base64(series.lower);
    json["upper"] = base64(series.upper);
  }
  return json;
}

std::string plot_json(const Plot& plot, std::size_t buckets) {
  const Extent e = extent_of(plot);
  Json json{{"title", plot.title}, {"x", axis_json(plot.x)}, {"y", axis_json(plot.y)},
            {"link", plot.link},   {"extent", {e.x0, e.x1}}, {"command", plot.stretch_command}};
  json["series"] = Json::array();
  for (const Series& s : plot.series)
    json["series"].push_back(series_json(s, s.lower.empty() ? thinner(s.points, buckets) : s.points));
  json["shades"] = Json::array();
  for (const Shade& s : plot.shades)
    json["shades"].push_back({{"from", s.from}, {"to", s.to}, {"label", s.label}, {"quiet", s.quiet}});
  json["guides"] = Json::array();
  for (const Guide& g : plot.guides)
    json["guides"].push_back({{"name", g.name}, {"x", {g.x0, g.x1}}, {"y", {g.y0, g.y1}}});
  return script_json(json);
}

std::string quantity(double value, const std::string& unit) {
  return unit.empty() || unit == "1" ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
}

/// The extremes of a curve in words, for readers without a script and on paper: every digit, and where.
std::string extremes(const Series& series, const Plot& plot) {
  const auto& p = series.points;
  std::optional<std::size_t> low, high;
  for (std::size_t i = 0; i < p.y.size(); ++i) {
    if (std::isnan(p.y[i])) continue;
    if (!low || p.y[i] < p.y[*low]) low = i;
    if (!high || p.y[i] > p.y[*high]) high = i;
  }
  if (!low) return "no values.";
  std::string text = fmt::format("smallest {} at {}, largest {} at {}; ", quantity(p.y[*low], plot.y.unit),
                                 quantity(p.x[*low], plot.x.unit), quantity(p.y[*high], plot.y.unit),
                                 quantity(p.x[*high], plot.x.unit));
  if (p.interval > 0.0)
    return text + fmt::format("{} samples, here the smallest and the largest of every {}.", p.samples,
                              quantity(std::stod(fmt::format("{:.4g}", p.interval)), plot.x.unit));
  return text + fmt::format("{} samples, all of them here.", p.samples);
}

/// Of plots over time alone: elsewhere the first and the last of x say little.
std::string extremes(const Plot& plot) {
  if (plot.link.empty() || plot.series.empty()) return {};
  if (plot.series.size() == 1) return paragraph(extremes(plot.series.front(), plot), "extremes");
  std::string html = "<details class=\"extremes\"><summary>Extremes, with every digit</summary>";
  for (const Series& s : plot.series) html += paragraph(s.name + ": " + extremes(s, plot), "extremes");
  return html + "</details>\n";
}

std::string whole_command(const Plot& plot) {
  const Extent e = extent_of(plot);
  std::string text = plot.stretch_command;
  const auto put = [&](const std::string& key, double value) {
    if (const auto at = text.find(key); at != std::string::npos)
      text.replace(at, key.size(), fmt::format("{:.6g}", value));
  };
  put("{from}", e.x0);
  put("{to}", e.x1);
  return text;
}

void write(Writer& w, const Plot& plot) {
  const std::string id = fmt::format("plot{}", ++w.plots);
  w.html += fmt::format("<figure class=\"plot\" id=\"{}\" data-height=\"{}\">\n<figcaption>{}</figcaption>\n",
                        id, plot.link.empty() ? 380 : 230, escaped(plot.title));
  // A single curve bears the plot's own name.
  if (plot.series.size() > 1) {
    w.html += "<div class=\"legend\">";
    for (std::size_t i = 0; i < plot.series.size(); ++i)
      w.html += fmt::format(
          "<button type=\"button\" aria-pressed=\"true\" data-series=\"{}\">{}<span>{}</span></button>", i,
          legend_key(i, plot.series[i].style), escaped(plot.series[i].name));
    w.html += "</div>\n";
  }
  w.html += "<div class=\"area\">" + plot_svg(plot, id) + "</div>\n";
  w.html += paragraph(plot.note, "note");
  w.html += extremes(plot);
  if (!plot.stretch_command.empty())
    w.html += fmt::format("<p class=\"stretch\">Every sample of the stretch in view: <code>{}</code></p>\n",
                          escaped(whole_command(plot)));
  w.html += "<script type=\"application/json\">" + plot_json(plot, w.buckets) + "</script>\n</figure>\n";
}

void write(Writer& w, const Paragraph& part) {
  w.html += paragraph(part.text, "text");
}

void write(Writer& w, const Verbatim& part) {
  w.html += "<pre tabindex=\"0\">" + escaped(part.text) + "</pre>\n";
}

void write(Writer& w, const Table& table) {
  std::vector<bool> right(table.columns.size(), true);
  for (const auto& row : table.rows)
    for (std::size_t c = 0; c < std::min(row.size(), right.size()); ++c)
      if (!row[c].empty() && row[c] != "–" && !is_number(row[c])) right[c] = false;
  w.html += "<div class=\"table\" tabindex=\"0\"><table>";
  if (!table.title.empty()) w.html += "<caption>" + escaped(table.title) + "</caption>";
  w.html += "<thead><tr>";
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    w.html +=
        fmt::format("<th scope=\"col\"{}>{}</th>", right[c] ? " class=\"n\"" : "", escaped(table.columns[c]));
  w.html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    w.html += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      w.html +=
          fmt::format("<td{}>{}</td>", c < right.size() && right[c] ? " class=\"n\"" : "", escaped(row[c]));
    w.html += "</tr>\n";
  }
  w.html += "</tbody></table></div>\n" + paragraph(table.note, "note");
}

void write(Writer& w, const Chain& chain) {
  w.html += "<figure class=\"chain\">\n" + chain_svg(chain);
  if (!chain.marks.empty()) {
    w.html += "<ul class=\"marks\">";
    for (const Mark& mark : chain.marks)
      w.html += fmt::format("<li><b>{}</b>: {}</li>", escaped(mark.stage), escaped(mark.text));
    w.html += "</ul>";
  }
  w.html += paragraph(chain.note, "note") + "</figure>\n";
}

void write(Writer& w, const Intervals& part) {
  w.html += intervals_html(part) + paragraph(part.note, "note");
}

void write(Writer& w, const Matrix& part) {
  w.html += matrix_html(part) + paragraph(part.note, "note");
}

void write_header(Writer& w, const Report& report) {
  const char* tone = report.tone == Tone::kGood        ? "good"
                     : report.tone == Tone::kAttention ? "attention"
                                                       : "neutral";
  w.html += "<header>\n<div class=\"top\"><p class=\"kind\">hemi <span>" + escaped(report.kind) + "</span> " +
            escaped(report.subject) + "</p><button type=\"button\" id=\"theme\" hidden>Dark</button></div>\n";
  w.html += fmt::format("<h1 id=\"verdict\" class=\"{}\">{}</h1>\n", tone, escaped(report.verdict));
  if (!report.facts.empty()) {
    w.html += "<dl>";
    for (const Fact& fact : report.facts)
      w.html += "<div><dt>" + escaped(fact.name) + "</dt><dd>" + escaped(fact.value) + "</dd></div>";
    w.html += "</dl>\n";
  }
  if (report.sections.size() > 2) {
    w.html += "<nav aria-label=\"Contents\">";
    for (std::size_t i = 0; i < report.sections.size(); ++i)
      w.html += fmt::format("<a href=\"#section{}\">{}</a>", i + 1, escaped(report.sections[i].heading));
    w.html += "</nav>\n";
  }
  w.html += "</header>\n";
}

void write_footer(Writer& w, const Report& report) {
  w.html += "<footer>\n";
  if (w.plots > 0)
    w.html +=
        "<p class=\"help\">Plots: drag across one to zoom, double-click for the whole; with the keyboard + "
        "and −, arrow "
        "keys, 0 for the whole; with two fingers on a touch screen. Names above a plot switch its "
        "curves.</p>\n";
  if (!report.command.empty()) w.html += "<p>Made by <code>" + escaped(report.command) + "</code></p>\n";
  w.html += "<p>hemi " HEMI_VERSION ". This file needs no network.";
  if (w.plots > 0) w.html += " Plots: uPlot, MIT licence.";
  w.html += "</p>\n</footer>\n";
}

std::size_t buckets_for(const Report& report) {
  std::size_t curves = 0;
  for (const auto& section : report.sections)
    for (const auto& part : section.parts)
      if (const auto* plot = std::get_if<Plot>(&part)) curves += plot->series.size();
  return std::min(kBuckets, std::max<std::size_t>(100, kPagePoints / 2 / std::max<std::size_t>(1, curves)));
}

}  // namespace

std::string to_html(const Report& report) {
  Writer w{.html = {}, .buckets = report.every_point ? every_bucket : buckets_for(report)};
  w.html = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  // The browser itself refuses whatever would leave the file.
  w.html +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "script-src "
      "'unsafe-inline'; img-src data:\">\n<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n";
  w.html += fmt::format("<title>{} {}</title>\n<style>\n{}\n{}</style>\n</head>\n<body>\n<main>\n",
                        escaped(report.kind), escaped(report.subject), assets::uplot_css, assets::page_css);
  write_header(w, report);
  for (std::size_t i = 0; i < report.sections.size(); ++i) {
    const Section& section = report.sections[i];
    w.html += fmt::format(
        "<section id=\"section{0}\" aria-labelledby=\"heading{0}\">\n<h2 id=\"heading{0}\">{1}</h2>\n", i + 1,
        escaped(section.heading));
    for (const auto& part : section.parts) std::visit([&](const auto& p) { write(w, p); }, part);
    w.html += "</section>\n";
  }
  write_footer(w, report);
  w.html += "</main>\n";
  if (w.plots > 0) w.html += fmt::format("<script>\n{}\n</script>\n", assets::uplot_js);
  w.html += fmt::format("<script>\n{}</script>\n</body>\n</html>\n", assets::page_js);
  return std::move(w.html);
}

}  // namespace hemi::report

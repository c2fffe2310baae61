// SPDX-License-Identifier: Apache-2.0
#include "cli/pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "cli/invocation.hpp"
#include "cli/report/ticks.hpp"
#include "cli/summary.hpp"

namespace hemi::cli {
namespace {

using report::nice_number;
using report::Plot;
using report::Section;
using report::Series;

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string with_unit(double value, const std::string& unit, int digits = 4) {
  return nice_number(value, digits) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

Section section_of(std::string heading, std::vector<Plot> plots) {
  Section section{std::move(heading), {}};
  for (Plot& plot : plots) section.parts.emplace_back(std::move(plot));
  return section;
}

report::Table allan_table(const AllanPage& page) {
  report::Table table{"", {"tau [s]", "deviation", "from", "to", "pairs"}, {}, {}};
  for (const auto& p : page.result.points)
    table.rows.push_back({nice_number(p.tau_s), nice_number(p.deviation, 4), nice_number(p.lower, 4),
                          nice_number(p.upper, 4), fmt::format("{}", p.pairs)});
  table.note =
      fmt::format("Deviation in {}, with the interval that holds the true value with 68.3 %.", page.unit);
  return table;
}

Plot allan_plot(const AllanPage& page) {
  Plot plot{
      .title = (page.separate ? "Allan deviation of " : "Overlapping Allan deviation of ") + page.channel,
      .x = {"averaging time", "s", true},
      .y = {"deviation", page.unit, true},
      .note = "Bars: 68 % intervals."};
  Series series{.name = page.channel};
  for (const auto& p : page.result.points) {
    series.points.x.push_back(p.tau_s);
    series.points.y.push_back(p.deviation);
    series.lower.push_back(p.lower);
    series.upper.push_back(p.upper);
  }
  const double first_s = series.points.x.front(), last_s = series.points.x.back();
  plot.series.push_back(std::move(series));
  if (const auto& walk = page.result.angle_random_walk)
    plot.guides.push_back({"angle random walk", first_s, walk->coefficient / std::sqrt(first_s), last_s,
                           walk->coefficient / std::sqrt(last_s)});
  if (const auto& flicker = page.result.flicker) {
    const double floor = 0.664 * flicker->coefficient;
    plot.guides.push_back({"bias instability × 0.664", first_s, floor, last_s, floor});
  }
  if (const auto& walk = page.result.rate_random_walk)
    plot.guides.push_back({"rate random walk", first_s, walk->coefficient * std::sqrt(first_s / 3.0), last_s,
                           walk->coefficient * std::sqrt(last_s / 3.0)});
  return plot;
}

std::string allan_verdict(const AllanPage& page) {
  const auto& r = page.result;
  std::string text = r.flicker ? fmt::format("The bias instability of {} is {}, from {} to {} s",
                                             page.channel, with_unit(r.flicker->coefficient, page.unit),
                                             nice_number(r.flicker->from_s), nice_number(r.flicker->to_s))
                               : fmt::format(
                                     "The bias instability of {} is at most {}: its Allan deviation is "
                                     "nowhere level, and least at {} s",
                                     page.channel, with_unit(r.bias_instability, page.unit),
                                     nice_number(r.bias_instability_tau_s));
  if (r.angle_random_walk && page.unit == "deg/h")
    text += fmt::format("; its angle random walk is {} deg/√h",
                        nice_number(r.angle_random_walk->deg_per_root_hour(), 4));
  else if (r.angle_random_walk)
    text += fmt::format("; its white noise is {} {}·√s", nice_number(r.angle_random_walk->coefficient, 4),
                        page.unit);
  else
    text += "; no stretch of slope −1/2 gives an angle random walk";
  return text + ".";
}

}  // namespace

std::string stretch_command(const std::string& recording) {
  return report::command_line(
      {"hemi", "report", recording, "--from", "{from}", "--to", "{to}", "--full", "-o", "stretch.html"});
}

std::vector<Plot> channel_plots(const recording::Recording& recording, const std::string& command,
                                std::size_t buckets) {
  std::vector<Plot> plots;
  const auto* time = recording.find("time_s");
  if (time == nullptr) return plots;
  const double longest_step_s = recording.sample_rate_hz > 0.0 ? 1.5 / recording.sample_rate_hz : 0.0;
  for (const auto& channel : recording.channels) {
    if (channel.name == "time_s" ||
        std::ranges::all_of(channel.values, [](double v) { return std::isnan(v); }))
      continue;
    Plot plot{.title = channel.name, .x = {"time", "s"}, .y = {channel.name, channel.unit}, .link = "time"};
    plot.series.push_back(Series::line(channel.name, time->values, channel.values, longest_step_s, buckets));
    plots.push_back(std::move(plot));
  }
  if (!plots.empty()) plots.back().stretch_command = command;
  return plots;
}

std::string write_allan_page(const std::string& target, const AllanPage& page) {
  const std::string path = report::report_path(target, "allan");
  report::Report document{.kind = "Allan deviation",
                          .subject = file_name(page.recording) + ", " + page.channel,
                          .verdict = allan_verdict(page),
                          .command = invocation()};
  const auto& flicker = page.result.flicker;
  document.facts = {
      {"Samples", fmt::format("{}", page.samples)},
      {"Interval", with_unit(page.interval_s, "s", 6)},
      {"Bias instability", flicker ? with_unit(flicker->coefficient, page.unit)
                                   : "at most " + with_unit(page.result.bias_instability, page.unit)}};
  if (const auto& walk = page.result.angle_random_walk)
    document.facts.push_back(
        {"Angle random walk", fmt::format("{} {}·√s, from {} to {} s", nice_number(walk->coefficient, 4),
                                          page.unit, nice_number(walk->from_s), nice_number(walk->to_s))});
  if (const auto& walk = page.result.rate_random_walk)
    document.facts.push_back(
        {"Rate random walk", fmt::format("{} {}/√s, from {} to {} s", nice_number(walk->coefficient, 4),
                                         page.unit, nice_number(walk->from_s), nice_number(walk->to_s))});
  if (page.bias_stability)
    document.facts.push_back({fmt::format("Bias stability, {:g} s averages", page.average_s),
                              with_unit(*page.bias_stability, page.unit)});
  Plot samples{.title = page.channel, .x = {"time", "s"}, .y = {page.channel, page.unit}, .link = "time"};
  samples.series.push_back(Series::line(page.channel, page.source.find("time_s")->values,
                                        page.source.find(page.channel)->values, 1.5 * page.interval_s));
  Section table{"The figures", {}};
  table.parts.emplace_back(allan_table(page));
  document.sections = {section_of("Allan deviation", {allan_plot(page)}), std::move(table),
                       section_of("The samples", {std::move(samples)})};
  report::write_report(path, document);
  return path;
}

namespace {

/// Verdict and tone from what `hemi run` prints as JSON.
void judge_run(const recording::Json& summary, report::Report& document) {
  const auto number = [&](const char* key) {
    return summary.contains(key) && summary[key].is_number() ? summary[key].get<double>() : 0.0;
  };
  if (summary.contains("compensated_deviation_dph")) {
    const double before = number("rate_deviation_dph"), after = number("compensated_deviation_dph");
    document.tone = after < before ? report::Tone::kGood : report::Tone::kAttention;
    document.verdict =
        fmt::format("Compensation {} the standard deviation of the rate from {} to {} deg/h.",
                    after < before ? "lowers" : "raises", nice_number(before, 4), nice_number(after, 4));
    document.facts = {
        {"Rows", fmt::format("{}", summary["rows"].get<std::size_t>())},
        {"Window of df/dt", with_unit(number("derivative_window_s"), "s")},
        {"Thermometer against f(T)", "within " + with_unit(number("thermometer_error_degc"), "degC", 2)}};
    return;
  }
  if (!(number("frequency_hz") > 0.0)) {
    document.tone = report::Tone::kAttention;
    document.verdict = "The loop did not lock: fewer than 20 outputs can be used.";
    return;
  }
  const double locked = 100.0 * number("locked_share");
  document.tone = locked > 99.0 ? report::Tone::kGood : report::Tone::kNeutral;
  const double drift_ppm = number("drift_ppm");
  document.verdict =
      fmt::format("Locked for {:.1f} % of the window at {:.6f} Hz, {}.", locked, number("frequency_hz"),
                  std::abs(drift_ppm) < 0.01 ? "drifting by less than 0.01 ppm"
                                             : fmt::format("with a drift of {:+.2f} ppm", drift_ppm));
  document.facts = {{"Outputs used", fmt::format("{}", summary["outputs"].get<std::size_t>())},
                    {"Frequency at the start", fmt::format("{:.6f} Hz", number("start_hz"))},
                    {"Frequency at the end", fmt::format("{:.6f} Hz", number("end_hz"))}};
  if (summary.contains("quality_factor"))
    document.facts.push_back({"Quality factor", fmt::format("{:.0f} ± {:.0f}", number("quality_factor"),
                                                            number("quality_factor_error"))});
}

/// Without the frequency of a loop that has not locked: it would set the axis, and all else were a line.
recording::Recording where_locked(recording::Recording output) {
  const auto* status = output.find("status");
  const auto frequency = std::ranges::find(output.channels, "frequency_hz", &recording::Channel::name);
  if (status == nullptr || frequency == output.channels.end()) return output;
  for (std::size_t i = 0; i < status->values.size(); ++i)
    if (!locked(status->values[i])) frequency->values[i] = std::numeric_limits<double>::quiet_NaN();
  return output;
}

}  // namespace

std::string write_run_page(const std::string& target, const recording::Recording& output,
                           const recording::Json& summary, const std::string& source,
                           const std::string& engine, const std::string& text) {
  const std::string path = report::report_path(target, "run");
  report::Report document{.kind = "run", .subject = file_name(source), .command = invocation()};
  judge_run(summary, document);
  document.facts.push_back({"Engine", engine});
  if (!output.device.empty()) document.facts.push_back({"Device", output.device});
  const std::string written = summary.value("output", std::string());
  Section words{"In words", {}};
  words.parts.emplace_back(report::Verbatim{text});
  document.sections = {
      section_of("Outputs over time",
                 channel_plots(where_locked(output), written.empty() ? "" : stretch_command(written))),
      std::move(words)};
  report::write_report(path, document);
  return path;
}

namespace {

report::Table pairs_table(const ComparePage& page) {
  report::Table table{
      "", {"engines", "result", "records", "words of all blocks", "first difference"}, {}, {}};
  for (const auto& pair : page.pairs)
    table.rows.push_back({pair.first + " and " + pair.second, pair.equal ? "no differing bit" : "differ",
                          fmt::format("{}", pair.records), fmt::format("{}", pair.words),
                          pair.equal ? ""
                          : pair.block.empty()
                              ? "the record itself"
                              : fmt::format("{}, {} at sample {}", pair.block, pair.word, pair.sample)});
  return table;
}

void judge_comparison(const ComparePage& page, report::Report& document) {
  const auto worst = std::ranges::find(page.pairs, false, &ComparedPair::equal);
  if (page.pairs.empty()) {
    document.verdict = "The ideal chain has no bits to compare: its differences are figures, below.";
    return;
  }
  if (worst == page.pairs.end()) {
    std::string names = page.pairs.front().first;
    for (const auto& pair : page.pairs) names += " = " + pair.second;
    document.tone = report::Tone::kGood;
    document.verdict = fmt::format("{}: no differing bit in {} records and {} words of all blocks.", names,
                                   page.pairs.front().records, page.pairs.front().words);
    return;
  }
  document.tone = report::Tone::kAttention;
  document.verdict = worst->block.empty()
                         ? fmt::format("{} and {} differ in their records although all blocks agree.",
                                       worst->first, worst->second)
                         : fmt::format("{} and {} differ first in {}, in its word {} at sample {}.",
                                       worst->first, worst->second, worst->block, worst->word, worst->sample);
}

/// Outputs of both engines in one plot a channel; of the first alone where none differs.
std::vector<Plot> compared_plots(const ComparePage& page) {
  std::vector<Plot> plots = channel_plots(page.outputs, "");
  if (page.differing.empty()) return plots;
  const auto* time = page.other_outputs.find("time_s");
  for (Plot& plot : plots) {
    const auto* other = page.other_outputs.find(plot.title);
    if (other == nullptr || time == nullptr) continue;
    plot.series.front().name = page.pairs.front().first;
    plot.series.push_back(Series::line(page.differing, time->values, other->values));
  }
  return plots;
}

}  // namespace

std::string write_compare_page(const std::string& target, const ComparePage& page) {
  const std::string path = report::report_path(target, "compare");
  report::Report document{
      .kind = "comparison", .subject = file_name(page.recording), .command = invocation()};
  judge_comparison(page, document);
  Section where{"Where", {}};
  report::Chain chain;
  for (const auto& pair : page.pairs)
    if (!pair.block.empty())
      chain.marks.push_back({pair.block, fmt::format("{} and {} differ first here, in {} at sample {}",
                                                     pair.first, pair.second, pair.word, pair.sample)});
  chain.note = chain.marks.empty()
                   ? "No block differs."
                   : "The first difference is marked; what lies before it in the data's order agrees.";
  where.parts.emplace_back(chain);
  where.parts.emplace_back(pairs_table(page));
  for (const auto& pair : page.pairs)
    if (!pair.report.empty()) where.parts.emplace_back(report::Verbatim{pair.report});
  document.sections.push_back(std::move(where));
  if (!page.ideal.empty()) {
    Section ideal{"Against the ideal chain", {}};
    ideal.parts.emplace_back(report::Verbatim{page.ideal});
    document.sections.push_back(std::move(ideal));
  }
  document.sections.push_back(section_of("Outputs over time", compared_plots(page)));
  report::write_report(path, document);
  return path;
}

}  // namespace hemi::cli

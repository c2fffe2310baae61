// SPDX-License-Identifier: Apache-2.0
// `hemi report`: any recording, or a stretch of it with every sample, as a page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/invocation.hpp"
#include "cli/options.hpp"
#include "cli/pages.hpp"
#include "cli/recording/error.hpp"
#include "cli/report/ticks.hpp"

namespace hemi::cli {
namespace {

struct ReportOptions {
  std::string recording;
  std::string output;
  std::vector<std::string> channels;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  bool full = false;
  bool json = false;
};

/// A raw capture as a recording: its time from the rate and the gaps.
recording::Recording from_capture(const recording::RawCapture& capture) {
  recording::Recording out{
      .path = capture.path, .device = capture.device, .sample_rate_hz = capture.sample_rate_hz};
  const std::size_t rows = capture.adc_x.size();
  std::vector<double> time_s(rows), x(rows), y(capture.adc_y.size());
  std::size_t gap = 0;
  double shift_s = 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    if (gap < capture.gaps.size() && capture.gaps[gap].after_row + 1 == i)
      shift_s += static_cast<double>(capture.gaps[gap++].missing_samples) / capture.sample_rate_hz;
    time_s[i] = static_cast<double>(i) / capture.sample_rate_hz + shift_s;
    x[i] = capture.adc_x[i];
    if (i < y.size()) y[i] = capture.adc_y[i];
  }
  out.channels = {{"time_s", "s", std::move(time_s)}, {"adc_x", "LSB", std::move(x)}};
  // A capture of one pickoff comes with zeros for the other.
  if (std::ranges::any_of(y, [](double v) { return v != 0.0; }))
    out.channels.push_back({"adc_y", "LSB", std::move(y)});
  out.gaps = capture.gaps;
  return out;
}

recording::Recording read(const std::string& path) {
  if (!recording::is_raw(path)) return recording::read_recording(path);
  return from_capture(recording::read_raw_capture(path, {}));
}

/// The channels asked for, between the two times.
recording::Recording stretch_of(recording::Recording all, const ReportOptions& options) {
  for (const auto& name : options.channels) all.require(name, "the report");
  const std::vector<double> time_s = all.find("time_s")->values;
  const auto first = std::ranges::lower_bound(time_s, options.from_s) - time_s.begin();
  const auto last = std::ranges::upper_bound(time_s, options.to_s) - time_s.begin();
  if (first >= last) {
    throw recording::InputError({options.recording},
                                fmt::format("has no row from {} s to {} s", options.from_s, options.to_s),
                                fmt::format("its rows go from {} s to {} s", time_s.front(), time_s.back()));
  }
  std::erase_if(all.channels, [&](const recording::Channel& c) {
    return c.name != "time_s" && !options.channels.empty() &&
           std::ranges::find(options.channels, c.name) == options.channels.end();
  });
  for (auto& channel : all.channels) {
    channel.values.erase(channel.values.begin() + last, channel.values.end());
    channel.values.erase(channel.values.begin(), channel.values.begin() + first);
  }
  const double from_s = time_s[static_cast<std::size_t>(first)],
               to_s = time_s[static_cast<std::size_t>(last) - 1];
  std::erase_if(all.gaps,
                [&](const recording::Gap& gap) { return gap.start_s < from_s || gap.end_s > to_s; });
  return all;
}

report::Table channel_table(const recording::Recording& recording) {
  report::Table table{"", {"channel", "unit", "values", "missing", "smallest", "largest", "mean"}, {}, {}};
  for (const auto& channel : recording.channels) {
    double n = 0, sum = 0, low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double v : channel.values) {
      if (std::isnan(v)) continue;
      n += 1;
      sum += v;
      low = std::min(low, v);
      high = std::max(high, v);
    }
    const bool any = n > 0;
    table.rows.push_back({channel.name, channel.unit, fmt::format("{:.0f}", n),
                          fmt::format("{:.0f}", static_cast<double>(channel.values.size()) - n),
                          any ? fmt::format("{}", low) : "–", any ? fmt::format("{}", high) : "–",
                          any ? fmt::format("{:.9g}", sum / n) : "–"});
  }
  return table;
}

report::Report page_of(const recording::Recording& part, const ReportOptions& options) {
  const auto& time_s = part.find("time_s")->values;
  std::size_t missing = 0;
  for (const auto& gap : part.gaps) missing += gap.missing_samples;
  constexpr std::size_t every_sample_fits = std::numeric_limits<std::size_t>::max() / 2;
  const auto plots = channel_plots(part, stretch_command(options.recording),
                                   options.full ? every_sample_fits : report::kBuckets);
  const bool every_sample = std::ranges::all_of(
      plots, [](const report::Plot& p) { return p.series.front().points.interval == 0.0; });
  report::Report page{.kind = "recording",
                      .subject = std::filesystem::path(options.recording).filename().string(),
                      .command = invocation()};
  page.tone = missing == 0 ? report::Tone::kGood : report::Tone::kAttention;
  page.verdict = fmt::format("{} channel{} from {:.6g} s to {:.6g} s, {} rows at {:.6g} Hz, {}.",
                             plots.size(), plots.size() == 1 ? "" : "s", time_s.front(), time_s.back(),
                             time_s.size(), part.sample_rate_hz,
                             missing == 0 ? std::string("no row missing")
                                          : fmt::format("{} rows missing in {} gap{}", missing,
                                                        part.gaps.size(), part.gaps.size() == 1 ? "" : "s"));
  page.every_point = options.full;
  if (!part.device.empty()) page.facts.push_back({"Device", part.device});
  page.facts.push_back({"Shown", every_sample ? "every sample" : "extremes of short stretches"});
  report::Section channels{"Channels over time", {}}, figures{"In figures", {}};
  for (const auto& plot : plots) channels.parts.emplace_back(plot);
  for (const auto& gap : part.gaps)
    for (auto& section_part : channels.parts)
      std::get<report::Plot>(section_part).shades.push_back({gap.start_s, gap.end_s, "gap"});
  figures.parts.emplace_back(channel_table(part));
  page.sections = {std::move(channels), std::move(figures)};
  return page;
}

int write_page(const ReportOptions& options) {
  check_stretch(options.from_s, options.to_s);
  refuse_settled_points(options.recording);
  refuse_overwriting({options.output}, {options.recording});
  const auto all = read(options.recording);
  print_notes(all.notes);
  const report::Report page = page_of(stretch_of(all, options), options);
  const std::string path = report::report_path(options.output, "report");
  report::write_report(path, page);
  if (options.json)
    fmt::print("{}\n", recording::json_text({{"verdict", page.verdict}, {"report", path}}, 2));
  else
    fmt::print("{}\nwrote {}\n", page.verdict, path);
  return exit_good;
}

}  // namespace

void add_report(CLI::App& app, Job& job) {
  auto options = std::make_shared<ReportOptions>();
  auto* command =
      app.add_subcommand("report", "A recording, or a stretch of it with every sample, as an HTML page");
  command->add_option("recording", options->recording, "telemetry, a raw capture, or an output of hemi run")
      ->required();
  command->add_option("-o,--output", options->output, report_option_help)->required();
  command->add_option("-c,--channels", options->channels, "these channels alone; default: all")
      ->delimiter(',');
  const auto finite = number_between(-1e300, 1e300);
  command->add_option("--from", options->from_s, "start of the stretch [s]")->check(finite);
  command->add_option("--to", options->to_s, "end of it [s]")->check(finite);
  command->add_flag("--full", options->full, "every sample, however many: 21 bytes each");
  command->add_flag("--json", options->json, "verdict and path as JSON");
  command->footer(
      "Example: hemi report chamber.csv -o chamber.html\n"
      "         hemi report chamber.csv --from 1200 --to 1230 --channels rate_dph --full -o stretch.html\n"
      "Without --full up to 8000 samples a channel are all in the page; of more, the smallest and the "
      "largest "
      "of each of 4000 stretches.");
  command->callback([options, &job] { job = [options] { return write_page(*options); }; });
}

}  // namespace hemi::cli

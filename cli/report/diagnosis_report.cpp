// SPDX-License-Identifier: Apache-2.0
#include "cli/report/diagnosis_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "cli/report/diagnosis_text.hpp"
#include "cli/report/residuals.hpp"
#include "cli/report/ticks.hpp"

namespace hemi::report {
namespace {

using recording::Json;
using Units = std::vector<std::pair<std::string, std::string>>;

void check(const ReportSeries& s) {
  const std::size_t rows = s.time_s.size();
  if (s.before.size() != rows || (!s.after.empty() && s.after.size() != rows) ||
      (!s.over.empty() && s.over.size() != rows))
    throw std::invalid_argument("the residuals of " + s.channel + " are of unequal length");
}

/// Stretches of `located` that belong to the channel.
std::vector<Shade> located_stretches(const Json& diagnosis, const std::string& channel) {
  std::vector<Shade> shades;
  const Json& located = member(diagnosis, "located");
  if (!located.is_array()) return shades;
  for (const Json& entry : located) {
    if (text_of(member(entry, "channel")) != channel) continue;
    const Json& list = member(entry, "time_s");
    if (!list.is_array()) continue;
    for (const Json& stretch : list)
      if (stretch.is_array() && stretch.size() == 2 && stretch[0].is_number() && stretch[1].is_number())
        shades.push_back({stretch[0], stretch[1], "misfit"});
  }
  return shades;
}

Plot residual_plot(const Json& diagnosis, const ReportSeries& s, const std::string& time_unit) {
  Plot plot{.title = "Residual of " + s.channel,
            .x = {"time", time_unit},
            .y = {"recorded − simulated", s.unit},
            .shades = located_stretches(diagnosis, s.channel),
            .link = "time"};
  plot.series.push_back(Series::line("before", s.time_s, s.before));
  if (!s.after.empty()) plot.series.push_back(Series::line("after", s.time_s, s.after));
  for (const auto& [from, to] : s.held_out_s) plot.shades.push_back({from, to, "held out", true});
  if (!plot.shades.empty())
    plot.note = "Shaded: where the misfit was located, and rows that the fit has not seen.";
  return plot;
}

Plot residual_over(const ReportSeries& s) {
  Plot plot{.title = fmt::format("Residual of {} over {}", s.channel, s.over_name),
            .x = {s.over_name, s.over_unit},
            .y = {"recorded − simulated", s.unit}};
  plot.series.push_back(Series::dots("before", s.over, s.before));
  if (!s.after.empty()) plot.series.push_back(Series::dots("after", s.over, s.after));
  return plot;
}

/// Allan deviation or spectrum, before and after; nothing where the rows do not suffice.
template <class Make>
std::optional<Plot> before_and_after(const ReportSeries& s, Plot plot, Make make) {
  if (auto series = make("before", s.time_s, s.before)) plot.series.push_back(std::move(*series));
  if (!s.after.empty())
    if (auto series = make("after", s.time_s, s.after)) plot.series.push_back(std::move(*series));
  if (plot.series.empty()) return std::nullopt;
  return plot;
}

Section where_section(const Json& diagnosis, const std::vector<ReportSeries>& series,
                      const DiagnosisPage& page) {
  Section section{"Where the model fails", {}};
  Chain chain;
  const Json& located = member(diagnosis, "located");
  if (located.is_array()) {
    for (const Json& entry : located) {
      const std::string stage = text_of(member(entry, "stage")), channel = text_of(member(entry, "channel"));
      const auto share = number_of(member(entry, "share_of_misfit"));
      chain.marks.push_back({stage.empty() ? channel : stage,
                             share ? fmt::format("{:.1f} % of the misfit, in {}", 100.0 * *share, channel)
                                   : "misfit in " + channel});
    }
  }
  if (chain.marks.empty()) chain.note = "No block is marked: nothing was located.";
  section.parts.emplace_back(chain);
  if (Table table = located_table(diagnosis, page.time_unit); !table.rows.empty())
    section.parts.emplace_back(table);
  for (const auto& s : series) {
    section.parts.emplace_back(residual_plot(diagnosis, s, page.time_unit));
    if (!s.over.empty()) section.parts.emplace_back(residual_over(s));
  }
  for (const Plot& plot : page.plots) section.parts.emplace_back(plot);
  return section;
}

Section what_section(const Json& diagnosis) {
  Section section{"What was left out", {}};
  const Json& effects = member(diagnosis, "effects");
  if (effects.is_array()) {
    for (const Json& effect : effects) {
      std::string words = in_words(text_of(member(effect, "id")));
      if (const auto p = number_of(member(effect, "probability")))
        words += fmt::format(", probability {}", nice_number(*p, 4));
      if (const std::string more = text_of(member(effect, "explanation")); !more.empty())
        words += ": " + more;
      section.parts.emplace_back(Paragraph{words + "."});
      if (const std::string equation = text_of(member(effect, "equation")); !equation.empty())
        section.parts.emplace_back(Verbatim{equation});
      if (Table table = parameter_table(effect); !table.rows.empty()) section.parts.emplace_back(table);
    }
  }
  return section;
}

Section proof_section(const Json& diagnosis, const std::vector<ReportSeries>& series, const Units& units,
                      const std::string& time_unit) {
  Section section{"Proof", {}};
  if (Table table = proof_table(diagnosis, units); !table.rows.empty()) {
    table.note = "Gain: before minus after. Floor: what no model of the library can go below on these rows.";
    section.parts.emplace_back(table);
  }
  if (const Json& decoys = member(diagnosis, "decoys"); decoys.is_object())
    section.parts.emplace_back(
        Paragraph{fmt::format("Decoys (candidates shifted in time or with random phases): {} of {} accepted.",
                              cell(member(decoys, "accepted")), cell(member(decoys, "made")))});
  for (Table& table : evidence_tables(diagnosis)) section.parts.emplace_back(std::move(table));
  const bool seconds = time_unit == "s";
  for (const auto& s : series) {
    Plot allan{.title = "Allan deviation of the residual of " + s.channel,
               .x = {"averaging time", time_unit, true},
               .y = {"deviation", s.unit, true},
               .note = "Bars: 68 % intervals. A modelled effect leaves the long times first."};
    if (auto plot = before_and_after(s, allan, allan_series)) section.parts.emplace_back(*plot);
    Plot spectrum{.title = "Spectrum of the residual of " + s.channel,
                  .x = {"frequency", seconds ? "Hz" : "1/sample", true},
                  .y = {"density", s.unit + (seconds ? "/√Hz" : "·√sample"), true}};
    if (auto plot = before_and_after(s, spectrum, spectrum_series)) section.parts.emplace_back(*plot);
  }
  return section;
}

Section open_section(const Json& diagnosis) {
  Section section{"What is not excluded", {}};
  if (Table table = limits_table(diagnosis); !table.rows.empty()) section.parts.emplace_back(table);
  std::vector<std::string> absent;
  if (const Json& list = member(diagnosis, "absent_channels"); list.is_array())
    for (const Json& channel : list) absent.push_back(text_of(channel));
  if (!absent.empty()) section.parts.emplace_back(Paragraph{"Not recorded: " + listed(absent) + "."});
  if (Table table = not_testable_table(diagnosis); !table.rows.empty()) section.parts.emplace_back(table);
  return section;
}

Section core_section(const Json& diagnosis) {
  Section section{"What the core can compensate", {}};
  const Json& core = member(diagnosis, "core");
  if (const std::string why = text_of(member(core, "not_written")); !why.empty())
    section.parts.emplace_back(Paragraph{"No registers: " + why + "."});
  Table table{"Effects as functions of frequency and df/dt",
              {"effect", "share of it in the rate", "share of it in the thermometer", "not"},
              {},
              {}};
  if (const Json& list = member(core, "compensates"); list.is_array())
    for (const Json& entry : list)
      table.rows.push_back({in_words(text_of(member(entry, "id"))), cell(member(entry, "share_of_rate")),
                            cell(member(entry, "share_of_temperature")), ""});
  if (const Json& list = member(core, "cannot"); list.is_array())
    for (const Json& entry : list)
      table.rows.push_back({in_words(text_of(member(entry, "id"))), "", "", text_of(member(entry, "why"))});
  if (!table.rows.empty()) section.parts.emplace_back(table);
  if (const Json& figures = member(core, "bias_stability_dph"); figures.is_object())
    section.parts.emplace_back(
        Paragraph{fmt::format("Bias stability at rest, averages over {} s: {} deg/h as given, {} with the "
                              "corrected model, {} in the core.",
                              cell(member(figures, "averaged_over_s")), cell(member(figures, "before")),
                              cell(member(figures, "after_model")), cell(member(figures, "after_core")))});
  if (const std::string registers = text_of(member(core, "registers")); !registers.empty())
    section.parts.emplace_back(Paragraph{
        fmt::format("Registers: {}; the model that they were made from, for hemi export and hemi run: {}.",
                    registers, text_of(member(core, "model")))});
  return section;
}

Section experiment_section(const Json& diagnosis) {
  Section section{"Which experiment would separate them", {}};
  if (Table table = alternatives_table(diagnosis); !table.rows.empty()) section.parts.emplace_back(table);
  return section;
}

Section rest_section(const Json& diagnosis) {
  Section section{"What remains", {}};
  const Json& after = member(diagnosis, "residual_after");
  if (const Json& white = member(after, "white"); white.is_boolean()) {
    std::string text = white.get<bool>() ? "What is left cannot be told from white noise"
                                         : "What is left is not white: something in it repeats or drifts";
    if (const auto p = number_of(member(after, "p_value")))
      text += fmt::format(" (p = {})", nice_number(*p, 3));
    if (const auto p = number_of(member(after, "force_p_value")))
      text += fmt::format("; its tie to the force has p = {}", nice_number(*p, 3));
    section.parts.emplace_back(Paragraph{text + "."});
  }
  if (const std::string model = text_of(member(diagnosis, "corrected_model")); !model.empty())
    section.parts.emplace_back(
        Paragraph{"The corrected model, which hemi simulate and hemi diagnose take: " + model + "."});
  return section;
}

std::vector<Fact> facts_of(const Json& diagnosis) {
  std::vector<Fact> facts;
  for (const auto& [key, name] :
       {std::pair{"verdict", "Verdict"}, std::pair{"recording", "Recording"}, std::pair{"model", "Model"}})
    if (const std::string value = text_of(member(diagnosis, key)); !value.empty())
      facts.push_back({name, value});
  const Json& effects = member(diagnosis, "effects");
  if (effects.is_array() && !effects.empty())
    facts.push_back({"Effects named", fmt::format("{}", effects.size())});
  return facts;
}

}  // namespace

void write_diagnosis_report(const std::string& path, const Json& diagnosis,
                            const std::vector<ReportSeries>& series, const DiagnosisPage& page) {
  Units units;
  for (const auto& s : series) {
    check(s);
    units.emplace_back(s.channel, s.unit);
  }
  const Verdict verdict = verdict_of(diagnosis, units);
  Report report{.kind = "diagnosis",
                .subject = text_of(member(diagnosis, "recording")),
                .verdict = verdict.sentence,
                .tone = verdict.tone,
                .facts = facts_of(diagnosis),
                .command = page.command};
  for (Section& section :
       std::vector<Section>{where_section(diagnosis, series, page), what_section(diagnosis),
                            proof_section(diagnosis, series, units, page.time_unit), open_section(diagnosis),
                            experiment_section(diagnosis), core_section(diagnosis), rest_section(diagnosis)})
    if (!section.parts.empty()) report.sections.push_back(std::move(section));
  write_report(path, report);
}

}  // namespace hemi::report

// SPDX-License-Identifier: Apache-2.0
#include "cli/report/prove_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <regex>

#include "cli/report/diagnosis_text.hpp"
#include "cli/report/report.hpp"
#include "cli/report/ticks.hpp"

namespace hemi::report {
namespace {

using recording::Json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Numbers of a target such as "<= 2 %" or "92 to 98 %".
std::vector<double> marks_of(const std::string& target) {
  static const std::regex number(R"([0-9]+(\.[0-9]+)?)");
  const double scale = target.find('%') == std::string::npos ? 1.0 : 0.01;
  std::vector<double> marks;
  for (std::sregex_iterator at(target.begin(), target.end(), number), end; at != end; ++at)
    marks.push_back(scale * std::stod(at->str()));
  return marks;
}

const Json& list_of(const Json& object, const char* key) {
  static const Json empty = Json::array();
  const Json& list = member(object, key);
  return list.is_array() ? list : empty;
}

bool missed(const Json& row) {
  return number_of(member(row, "value")) && member(row, "held").is_boolean() &&
         !member(row, "held").get<bool>();
}

/// "0.96 [0.94, 0.97]" of the row of that key in a rival's list.
std::string rival_cell(const Json& rival, const std::string& key) {
  for (const Json& row : list_of(rival, "rows"))
    if (text_of(member(row, "key")) == key && number_of(member(row, "value")))
      return nice_number(*number_of(member(row, "value")), 3);
  return "–";
}

Intervals figures(const Json& proof) {
  Intervals part;
  const Json& rivals = member(proof, "rivals");
  if (rivals.is_object())
    for (const auto& [method, rival] : rivals.items()) part.others.push_back(in_words(method));
  for (const Json& row : list_of(proof, "rows")) {
    Intervals::Row out{.name = text_of(member(row, "text")), .value = kNone, .low = kNone, .high = kNone};
    out.target = text_of(member(row, "target"));
    out.target_marks = marks_of(out.target);
    for (const auto& [ascii, sign] : {std::pair{"<=", "≤"}, std::pair{">=", "≥"}})
      if (out.target.starts_with(ascii)) out.target.replace(0, 2, sign);
    out.count = text_of(member(row, "trials"));
    if (const auto value = number_of(member(row, "value"))) {
      out.value = out.low = out.high = *value;
      if (const Json& interval = member(row, "ci95"); interval.is_array() && interval.size() == 2) {
        out.low = number_of(interval[0]).value_or(*value);
        out.high = number_of(interval[1]).value_or(*value);
      }
      if (!out.target.empty()) out.outcome = missed(row) ? "missed" : "held";
    } else {
      out.outcome = "not measured";
    }
    out.stands_out = missed(row);
    if (rivals.is_object())
      for (const auto& [method, rival] : rivals.items())
        out.others.push_back(rival_cell(rival, text_of(member(row, "key"))));
    part.rows.push_back(std::move(out));
  }
  part.note =
      "Dot and bar: value and 95 % interval; dashed tick: target. Beyond the scale they stand at its end.";
  return part;
}

Matrix confusion(const Json& matrix, const std::string& title) {
  Matrix part{.title = title};
  if (!matrix.is_object()) return part;
  const auto is_known = [&](const std::string& name) {
    return std::ranges::find(part.columns, name) != part.columns.end();
  };
  // Columns in the order of the rows first, so that right answers stand on the diagonal.
  for (const auto& [truth, given] : matrix.items()) part.rows.push_back(truth);
  for (const auto& truth : part.rows)
    for (const auto& [other, given] : matrix.items())
      if (given.is_object() && given.contains(truth) && !is_known(truth)) part.columns.push_back(truth);
  for (const auto& [truth, given] : matrix.items())
    if (given.is_object())
      for (const auto& [answer, count] : given.items())
        if (!is_known(answer)) part.columns.push_back(answer);
  for (const auto& [truth, given] : matrix.items()) {
    std::vector<int> counts;
    for (const auto& answer : part.columns)
      counts.push_back(given.is_object() && given.contains(answer) && given[answer].is_number()
                           ? given[answer].get<int>()
                           : 0);
    part.counts.push_back(std::move(counts));
  }
  part.note = "Shade: share of the row. Framed: the answer is the truth.";
  return part;
}

Section class_section(const Json& proof) {
  Section section{"Right answers by class", {}};
  const Json& classes = member(proof, "classes");
  if (!classes.is_object()) return section;
  Intervals part;
  for (const auto& [name, entry] : classes.items()) {
    const auto right = number_of(member(entry, "right")), all = number_of(member(entry, "recordings"));
    Intervals::Row row{.name = in_words(name), .value = kNone, .low = kNone, .high = kNone};
    row.count = text_of(member(entry, "recordings"));
    if (right && all && *all > 0.0) {
      row.value = row.low = row.high = *right / *all;
      if (const Json& interval = member(entry, "ci95"); interval.is_array() && interval.size() == 2) {
        row.low = number_of(interval[0]).value_or(row.value);
        row.high = number_of(interval[1]).value_or(row.value);
      }
      row.outcome = fmt::format("{:.0f} right", *right);
    }
    part.rows.push_back(std::move(row));
  }
  if (!part.rows.empty()) section.parts.emplace_back(std::move(part));
  return section;
}

/// Probabilities that were stated against the share of names that was right, with intervals; on the line both
/// agree.
Section calibration_section(const Json& proof) {
  Section section{"Stated probabilities", {}};
  Series series{.name = "names", .style = Style::kPoints};
  Table table{"", {"stated, mean of the bin", "right", "95 % interval", "names"}, {}, {}};
  for (const Json& bin : list_of(proof, "calibration")) {
    const auto stated = number_of(member(bin, "stated")), right = number_of(member(bin, "right"));
    const Json& interval = member(bin, "ci95");
    if (!stated || !right || !interval.is_array() || interval.size() != 2) continue;
    series.points.x.push_back(*stated);
    series.points.y.push_back(*right);
    series.lower.push_back(number_of(interval[0]).value_or(*right));
    series.upper.push_back(number_of(interval[1]).value_or(*right));
    table.rows.push_back(
        {nice_number(*stated, 3), nice_number(*right, 3), range_of(interval), text_of(member(bin, "names"))});
  }
  if (table.rows.empty()) return section;
  series.points.samples = series.points.x.size();
  Plot plot{.title = "Share of right names over stated probability",
            .x = {"stated probability", "1"},
            .y = {"share that was right", "1"},
            .note = "Bars: 95 % intervals. A bar that meets the line does not contradict what was stated."};
  plot.series.push_back(std::move(series));
  plot.guides = {{"stated = right", 0.0, 0.0, 1.0, 1.0}};
  section.parts.emplace_back(std::move(plot));
  section.parts.emplace_back(std::move(table));
  return section;
}

Section failure_section(const Json& proof) {
  Section section{"Failures, one by one", {}};
  Table table{"", {"recording", "class", "run", "d′", "concealed", "said", "why"}, {}, {}};
  for (const Json& f : list_of(proof, "failures"))
    table.rows.push_back({text_of(member(f, "recording")), in_words(text_of(member(f, "class"))),
                          text_of(member(f, "scenario")), cell(member(f, "dprime")),
                          text_of(member(f, "concealed")), text_of(member(f, "said")),
                          text_of(member(f, "why"))});
  if (!table.rows.empty()) section.parts.emplace_back(std::move(table));
  return section;
}

void judge(const Json& proof, Report& report) {
  int measured = 0;
  std::vector<std::string> names;
  for (const Json& row : list_of(proof, "rows")) {
    if (text_of(member(row, "target")).empty() || !number_of(member(row, "value"))) continue;
    ++measured;
    if (missed(row)) names.push_back(text_of(member(row, "text")));
  }
  const std::string recordings = text_of(member(proof, "recordings"));
  if (measured == 0) {
    report.verdict = "No figure was measured.";
  } else if (names.empty()) {
    report.tone = Tone::kGood;
    report.verdict =
        fmt::format("All {} figures with a target hold over {} concealed recordings.", measured, recordings);
  } else {
    report.tone = Tone::kAttention;
    const std::size_t shown = std::min<std::size_t>(2, names.size());
    report.verdict =
        fmt::format("{} of {} figures {} over {} concealed recordings: {}{}.", names.size(), measured,
                    names.size() == 1 ? "misses its target" : "miss their target", recordings,
                    listed({names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown)}),
                    names.size() > shown ? " among them" : "");
  }
}

}  // namespace

void write_prove_report(const std::string& path, const Json& proof) {
  Report report{.kind = "proof by concealed recordings", .command = text_of(member(proof, "command"))};
  judge(proof, report);
  for (const auto& [key, name] : {std::pair{"recordings", "Recordings"}, std::pair{"seed", "Seed"},
                                  std::pair{"machine", "Machine"}, std::pair{"date", "Date"}})
    if (const std::string value = text_of(member(proof, key)); !value.empty())
      report.facts.push_back({name, value});
  if (const auto s = number_of(member(proof, "longest_diagnosis_s")))
    report.facts.push_back({"Longest diagnosis", nice_number(*s, 3) + " s"});
  if (const auto m = number_of(member(proof, "largest_diagnosis_mib")))
    report.facts.push_back({"Largest diagnosis", nice_number(*m, 4) + " MiB"});
  Section all{"Figures", {}};
  if (Intervals part = figures(proof); !part.rows.empty()) all.parts.emplace_back(std::move(part));
  Section said{"What was said for what was concealed", {}};
  if (Matrix part = confusion(member(proof, "confusion"), "hemi"); !part.rows.empty())
    said.parts.emplace_back(std::move(part));
  if (const Json& rivals = member(proof, "rivals"); rivals.is_object())
    for (const auto& [method, rival] : rivals.items())
      if (Matrix part = confusion(member(rival, "confusion"), in_words(method)); !part.rows.empty())
        said.parts.emplace_back(std::move(part));
  for (Section section : {std::move(all), class_section(proof), calibration_section(proof), std::move(said),
                          failure_section(proof)})
    if (!section.parts.empty()) report.sections.push_back(std::move(section));
  write_report(path, report);
}

}  // namespace hemi::report

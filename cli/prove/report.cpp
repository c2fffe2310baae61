// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

namespace hemi::prove {
namespace {

using recording::Json;

std::string figure(const Row& row) {
  if (row.trials == 0) return "-";
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]", row.value, row.low, row.high);
}

Json rows_json(const Score& score) {
  Json rows = Json::array();
  for (const Row& row : score.rows()) {
    Json json{{"key", row.key}, {"text", row.text}, {"trials", row.trials}};
    if (row.trials > 0) {
      json["value"] = row.value;
      json["ci95"] = {row.low, row.high};
    }
    if (!row.target.empty()) {
      json["target"] = row.target;
      json["held"] = row.held;
    }
    rows.push_back(json);
  }
  return rows;
}

Json confusion_json(const Score& score) {
  Json matrix = Json::object();
  for (const auto& [truth, given] : score.confusion()) {
    matrix[truth] = Json::object();
    for (const auto& [answer, count] : given) matrix[truth][answer] = count;
  }
  return matrix;
}

// Stated probabilities in ten bins, as calibration_error() takes them: mean stated, share right.
Json calibration_json(const Score& score) {
  constexpr int kBins = 10;
  std::array<Rate, kBins> rates{};
  std::array<double, kBins> sums{};
  for (const auto& [probability, right] : score.stated()) {
    const auto bin =
        static_cast<std::size_t>(std::clamp(static_cast<int>(probability * kBins), 0, kBins - 1));
    rates[bin].add(right);
    sums[bin] += probability;
  }
  Json bins = Json::array();
  for (std::size_t bin = 0; bin < rates.size(); ++bin) {
    const Rate& rate = rates[bin];
    if (rate.trials == 0) continue;
    const auto [low, high] = wilson95(rate);
    bins.push_back({{"stated", sums[bin] / rate.trials},
                    {"right", rate.value()},
                    {"ci95", {low, high}},
                    {"names", rate.trials}});
  }
  return bins;
}

std::string confusion_table(const Score& score) {
  std::set<std::string> answers;
  for (const auto& [truth, given] : score.confusion())
    for (const auto& [answer, count] : given) answers.insert(answer);
  std::string text = "| concealed \\ said |", rule = "| --- |";
  for (const auto& answer : answers) {
    text += fmt::format(" {} |", answer);
    rule += " --- |";
  }
  text += "\n" + rule + "\n";
  for (const auto& [truth, given] : score.confusion()) {
    text += fmt::format("| {} |", truth);
    for (const auto& answer : answers) {
      const auto cell = given.find(answer);
      text += cell == given.end() ? "  |" : fmt::format(" {} |", cell->second);
    }
    text += "\n";
  }
  return text;
}

}  // namespace

bool all_held(const Report& report) {
  const auto rows = report.own->rows();
  return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.held; });
}

Json to_json(const Report& report) {
  Json json{{"format", "hemi-proof/1"},        {"command", report.command},
            {"machine", report.machine},       {"date", report.date},
            {"seconds", report.seconds},       {"seed", report.seed},
            {"recordings", report.recordings}, {"all_held", all_held(report)},
            {"rows", rows_json(*report.own)}};
  json["longest_diagnosis_s"] = report.own->longest_s();
  json["largest_diagnosis_mib"] = report.own->peak_mib();
  for (const auto& [cls, rate] : report.own->by_class()) {
    const auto [low, high] = wilson95(rate);
    json["classes"][cls] = {{"right", rate.hits}, {"recordings", rate.trials}, {"ci95", {low, high}}};
  }
  json["confusion"] = confusion_json(*report.own);
  json["calibration"] = calibration_json(*report.own);
  json["failures"] = Json::array();
  for (const Failure& failure : report.own->failures())
    json["failures"].push_back({{"recording", failure.name},
                                {"class", failure.cls},
                                {"scenario", failure.scenario},
                                {"dprime", failure.dprime},
                                {"concealed", failure.truth},
                                {"said", failure.answer},
                                {"why", failure.why}});
  for (const auto& [method, score] : report.rivals)
    json["rivals"][method] = {{"rows", rows_json(score)}, {"confusion", confusion_json(score)}};
  return json;
}

std::string to_markdown(const Report& report) {
  std::string text = fmt::format(
      "# Proof by concealed recordings\n\n`{}`, {} recordings, seed {}, {:.0f} s, {}, {}.\n"
      "Longest diagnosis {:.1f} s, largest {:.0f} MiB. Intervals: Wilson 95 % for rates.\n\n"
      "| figure | target | n | hemi | held |",
      report.command, report.recordings, report.seed, report.seconds, report.machine, report.date,
      report.own->longest_s(), report.own->peak_mib());
  std::string rule = "| --- | --- | --- | --- | --- |";
  std::map<std::string, std::vector<Row>> rival_rows;
  for (const auto& [method, score] : report.rivals) {
    text += fmt::format(" {} |", method);
    rule += " --- |";
    rival_rows[method] = score.rows();
  }
  text += "\n" + rule + "\n";
  const auto rows = report.own->rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    text += fmt::format("| {} | {} | {} | {} | {} |", row.text, row.target, row.trials, figure(row),
                        row.target.empty() || row.trials == 0 ? ""
                        : row.held                            ? "yes"
                                                              : "**no**");
    for (const auto& [method, others] : rival_rows) text += fmt::format(" {} |", figure(others[i]));
    text += "\n";
  }
  text += "\n## Confusion\n\n" + confusion_table(*report.own);
  text += fmt::format("\n## Failures: {}\n\n", report.own->failures().size());
  if (report.own->failures().empty()) return text;
  text +=
      "| recording | class | run | d' | concealed | said | why |\n| --- | --- | --- | --- | --- | --- | --- "
      "|\n";
  for (const Failure& f : report.own->failures())
    text += fmt::format("| {} | {} | {} | {:.3g} | {} | {} | {} |\n", f.name, f.cls, f.scenario, f.dprime,
                        f.truth, f.answer, f.why);
  return text;
}

}  // namespace hemi::prove

// SPDX-License-Identifier: Apache-2.0
#include "cli/separating_scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/recording/error.hpp"
#include "cli/recording/write.hpp"
#include "cli/scenario/scenario.hpp"

namespace hemi::cli {
namespace {

namespace fs = std::filesystem;
using diagnosis::Corner;
using diagnosis::ExpectedGap;
using diagnosis::Experiment;
using diagnosis::Stand;
using diagnosis::Stimulus;
using recording::Json;

constexpr double kStep_s = 1.0;  // an input takes a sample to reach its new value
constexpr double kWarm_s = 1e5;

std::string pairs(const std::vector<Corner>& corners) {
  std::string text = "[";
  for (const Corner& corner : corners)
    text += fmt::format("{}[{:.10g}, {:.10g}]", text.size() > 1 ? ", " : "", corner.time_s, corner.value);
  return text + "]";
}

// Section of an input that is stepped, as a profile from its rest value; of one that rests elsewhere than a
// scenario's own, as a constant.
std::string section(const Experiment& experiment, const Stand& stand, Stimulus stimulus, const char* name,
                    const char* constant, double usual) {
  const double rest = diagnosis::rest_value(stimulus, stand);
  const auto found = experiment.steps.find(stimulus);
  if (found == experiment.steps.end())
    return rest == usual ? "" : fmt::format("\n[{}]\n{} = {:.10g}\n", name, constant, rest);
  std::vector<Corner> profile = {{0.0, rest}};
  for (const Corner& corner : found->second) {
    profile.push_back({corner.time_s, profile.back().value});
    profile.push_back({corner.time_s + kStep_s, corner.value});
  }
  return fmt::format("\n[{}]\nprofile = {}\n", name, pairs(profile));
}

bool about(const diagnosis::SeparatingExperiment& found, const char* effect) {
  const auto is_it = [&](const ExpectedGap& gap) { return gap.truth == effect || gap.rival == effect; };
  return std::ranges::any_of(found.gaps, is_it);
}

std::string listed(const std::vector<ExpectedGap>& gaps, const char* format_each) {
  std::string text;
  for (const ExpectedGap& each : gaps)
    text +=
        (text.empty() ? "" : ", ") + fmt::format(fmt::runtime(format_each), each.truth, each.rival, each.gap);
  return text;
}

Json listed_in_json(const std::vector<ExpectedGap>& gaps) {
  Json list = Json::array();
  for (const ExpectedGap& each : gaps)
    list.push_back({{"effects", {each.truth, each.rival}}, {"expected_score_gap", each.gap}});
  return list;
}

}  // namespace

std::string experiment_sentence(const diagnosis::SeparatingExperiment& found) {
  if (!found.experiment)
    return fmt::format("nothing tried separates {} (expected score gaps; {:g} would name one)",
                       listed(found.inseparable, "{} from {} ({:.1f})"), diagnosis::kNameMargin);
  std::string text = fmt::format("{}: expected score gaps {}", found.experiment->in_words(),
                                 listed(found.gaps, "{} against {} {:.0f}"));
  if (!found.enough)
    text += fmt::format(" (the most that was found; {:.0f} would be safe)", diagnosis::enough_gap());
  if (!found.inseparable.empty())
    text += fmt::format("; nothing tried separates {}", listed(found.inseparable, "{} from {} ({:.1f})"));
  return text;
}

std::string scenario_text(const diagnosis::SeparatingExperiment& found, const std::string& model) {
  const Experiment& e = found.experiment.value();
  const Stand& s = found.stand;
  std::string text =
      fmt::format("# {}\n\n[scenario]\nname = \"separating_experiment\"\nduration_s = {:.10g}\n",
                  experiment_sentence(found), e.duration_s);
  text += fmt::format(
      "\n[instrument]\nmodel = \"{}\"\ncase_time_constant_s = {:.6g}\nboard_rise_degc = "
      "{:.6g}\nboard_time_constant_s = {:.6g}\n",
      model, s.case_time_constant_s, s.board_rise_degc, s.heater_time_constant_s);
  text += fmt::format("\n[chamber]\nprofile = {}\n", pairs(e.chamber_degc));
  text += section(e, s, Stimulus::rate, "table", "rate_dph", 0.0);
  std::string supply = section(e, s, Stimulus::supply, "supply", "supply_v", 5.0);
  // Warm before the run, as the search has it; but what warms up after power-on shows only there.
  if (!about(found, "self_heating"))
    supply = (supply.empty() ? "\n[supply]\n" : supply) + fmt::format("power_on = {:g}\n", -kWarm_s);
  text += supply;
  text += section(e, s, Stimulus::attitude, "attitude", "accel_g", 0.0);
  text += section(e, s, Stimulus::amplitude, "amplitude", "setpoint", 1.0);
  text += section(e, s, Stimulus::trim, "quadrature", "trim_v", 0.0);
  text += section(e, s, Stimulus::board_heater, "board", "heater_degc", 0.0);
  return text;
}

void add_separating_experiment(Json& json, const diagnosis::TelemetryDiagnosis& result,
                               const diagnosis::NominalModel& nominal,
                               const recording::InstrumentModel& given, const std::string& directory,
                               const diagnosis::ExperimentOptions& options) {
  const std::string path = (fs::path(directory) / kSeparatingScenario).string();
  const std::string model_path = (fs::path(directory) / kSeparatingModel).string();
  // One of an earlier run would pass for this one's.
  fs::remove(path);
  fs::remove(model_path);
  if (result.verdict != diagnosis::Verdict::ambiguous && result.verdict != diagnosis::Verdict::named) return;
  const auto found = diagnosis::find_separating_experiment(result, nominal, options);
  if (!found) return;
  const std::string words = experiment_sentence(*found);
  Json& entry = json["separating_experiment"] = {{"file", nullptr},
                                                 {"in_words", words},
                                                 {"pairs", listed_in_json(found->gaps)},
                                                 {"not_separated", listed_in_json(found->inseparable)},
                                                 {"enough", found->enough},
                                                 {"tried", found->tried}};
  for (auto& alternative : json["alternatives"]) alternative["experiment_in_words"] = words;
  if (!found->experiment) return;
  entry["duration_s"] = found->experiment->duration_s;
  recording::write_model(model_path, given);
  recording::write_text(path, scenario_text(*found, kSeparatingModel));
  try {
    scenario::read_scenario(path);
  } catch (const recording::InputError& error) {
    // A model may hold what no simulated instrument can have; then the sentence stands alone.
    fs::remove(path);
    fs::remove(model_path);
    entry["why_no_file"] = error.what();
    return;
  }
  entry["file"] = kSeparatingScenario;
  for (auto& alternative : json["alternatives"]) alternative["separating_experiment"] = kSeparatingScenario;
}

}  // namespace hemi::cli

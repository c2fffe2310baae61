// SPDX-License-Identifier: Apache-2.0
#include "cli/diagnose_core.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "cli/calibrate.hpp"
#include "cli/core_compensation.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/write.hpp"
#include "cli/register_image.hpp"
#include "golden/calibration/compensation_score.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

namespace fs = std::filesystem;
using calibration::RowRange;
using diagnosis::CoreShare;
using diagnosis::Output;
using diagnosis::TelemetryDiagnosis;
using recording::Json;
constexpr double kAverage_s = 100.0;

std::vector<RowRange> rows_in_all(const std::vector<const Eigen::VectorXd*>& series) {
  std::vector<RowRange> ranges;
  Eigen::Index begin = 0;
  const Eigen::Index n = series[0]->size();
  for (Eigen::Index i = 0; i <= n; ++i) {
    const bool there =
        i < n && std::ranges::none_of(series, [&](const auto* s) { return std::isnan((*s)[i]); });
    if (there) continue;
    if (i > begin) ranges.push_back({begin, i - begin});
    begin = i + 1;
  }
  return ranges;
}

// Standard deviations of averages over kAverage_s, as they would be at rest: what effects make of steps and
// turns is no business of the compensation. Null where the recording cannot give them.
Json bias_stability(const TelemetryDiagnosis& result, const Eigen::VectorXd& driven_dph,
                    const recording::InstrumentModel& given, const recording::InstrumentModel& core) {
  auto t = *result.telemetry;
  if (!t.has(Output::frequency) || !t.has(Output::rate)) return nullptr;
  t.outputs[place(Output::rate)] -= driven_dph;
  const Eigen::VectorXd before = run_core(t, given).residual_dph;
  const Eigen::VectorXd after_core = run_core(t, core).residual_dph;
  const Eigen::VectorXd after_model = (*result.telemetry)[Output::rate] - corrected_rate(result);
  const auto rows = rows_in_all({&before, &after_core, &after_model});
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(before.size());
  const auto with = [&](const Eigen::VectorXd& after) {
    return calibration::score_compensation(before, after, still, rows, t.step_s, kAverage_s, 1.0).all;
  };
  try {
    const auto model = with(after_model), engine = with(after_core);
    return {{"averaged_over_s", kAverage_s},
            {"before", model.before_dph},
            {"after_model", model.after_dph},
            {"after_core", engine.after_dph}};
  } catch (const std::invalid_argument&) {
    return nullptr;  // no stretch that lasts two averages
  }
}

// Share above which nothing is left to speak of.
constexpr double kWhole = 0.95;

std::string why_not(const CoreShare& share) {
  if (!share.traced) return "has no course that a function of frequency and df/dt could follow";
  if (!share.in_rate && !share.in_frequency)
    return "at rest it moves neither the rate nor the frequency at a temperature";
  std::string text;
  if (share.in_rate && share.rate < kWhole)
    text = fmt::format("{:.0f} % of what it does to the rate is no function of frequency and df/dt",
                       100.0 * (1.0 - share.rate));
  if (share.in_frequency && share.temperature < kWhole)
    text += fmt::format("{}{:.0f} % of what it does to the frequency is no function of temperature",
                        text.empty() ? "" : "; ", 100.0 * (1.0 - share.temperature));
  return text;
}

// An effect of which the core can take a part is in both lists.
void list_effects(const std::vector<CoreShare>& shares, Json& section) {
  section["compensates"] = section["cannot"] = Json::array();
  for (const CoreShare& share : shares) {
    Json taken = {{"id", share.effect}};
    if (share.rate >= diagnosis::kLeastCoreShare) taken["share_of_rate"] = share.rate;
    if (share.temperature >= diagnosis::kLeastCoreShare) taken["share_of_temperature"] = share.temperature;
    if (taken.size() > 1) section["compensates"].push_back(taken);
    if (const std::string why = why_not(share); !why.empty())
      section["cannot"].push_back({{"id", share.effect}, {"why", why}});
  }
}

}  // namespace

Json write_core(const TelemetryDiagnosis& result, const diagnosis::NominalModel& nominal,
                const recording::InstrumentModel& given, const recording::InstrumentModel& corrected,
                const std::string& directory) {
  const bool found = !result.named.empty() || result.verdict == diagnosis::Verdict::recalibrate;
  if (!found || !given.frequency || !given.bias) return nullptr;
  Json section;
  try {
    const auto correction =
        diagnosis::core_correction(result, nominal, {core_derivative_late_s(), given.amplitude_setpoint});
    const auto model = core_model(corrected, correction);
    const Setup setup = core_setup(model, std::nullopt);
    list_effects(correction.shares, section);
    section["bias_stability_dph"] = bias_stability(result, correction.driven_dph, given, model);
    recording::write_model((fs::path(directory) / "core.model.json").string(), model);
    recording::write_text((fs::path(directory) / "core.registers.json").string(),
                          image_as_json(tb::to_image(setup.values), setup.values, model.device));
  } catch (const recording::InputError& error) {
    return {{"not_written", error.what()}};
  } catch (const tb::FormatError& error) {
    return {{"not_written", error.what()}};
  }
  section["model"] = "core.model.json";
  section["registers"] = "core.registers.json";
  return section;
}

std::string core_text(const Json& core) {
  if (core.is_null()) return "";
  if (core.contains("not_written"))
    return fmt::format("no registers for the core: {}\n", core["not_written"].get<std::string>());
  std::string text;
  for (const auto& entry : core["compensates"]) {
    text += fmt::format("the core can compensate {}:", entry["id"].get<std::string>());
    if (entry.contains("share_of_rate"))
      text += fmt::format(" {:.0f} % of it in the rate", 100.0 * entry["share_of_rate"].get<double>());
    if (entry.contains("share_of_temperature"))
      text += fmt::format(" {:.0f} % of it in the thermometer",
                          100.0 * entry["share_of_temperature"].get<double>());
    text += "\n";
  }
  for (const auto& entry : core["cannot"])
    text += fmt::format("the core cannot compensate {}: {}\n", entry["id"].get<std::string>(),
                        entry["why"].get<std::string>());
  if (const auto& figures = core["bias_stability_dph"]; figures.is_object())
    text += fmt::format(
        "bias stability over {:.0f} s at rest: {:.4g} deg/h, with the corrected model {:.4g}, in the core "
        "{:.4g}\n",
        figures["averaged_over_s"].get<double>(), figures["before"].get<double>(),
        figures["after_model"].get<double>(), figures["after_core"].get<double>());
  return text;
}

}  // namespace hemi::cli

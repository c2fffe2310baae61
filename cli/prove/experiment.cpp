// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "cli/recording/json.hpp"
#include "cli/recording/recording.hpp"

namespace hemi::prove {
namespace {

namespace fs = std::filesystem;
using concealed::Series;

constexpr Eigen::Index kShortest_s = 1800;
constexpr Eigen::Index kAtStart_s = 60;

/// One value a second: means over the samples of each, the last value where there is none.
Series each_second(const std::vector<double>& time_s, const std::vector<double>& values,
                   Eigen::Index seconds) {
  Series sums = Series::Zero(seconds), counts = Series::Zero(seconds);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(std::lround(time_s[i] - time_s[0]));
    if (at >= seconds || std::isnan(values[i])) continue;
    sums[at] += values[i];
    counts[at] += 1.0;
  }
  double last = 0.0;
  for (Eigen::Index i = 0; i < seconds; ++i) sums[i] = last = counts[i] > 0.0 ? sums[i] / counts[i] : last;
  return sums;
}

Series smoothed(const Series& values, Eigen::Index half) {
  Series result(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const Eigen::Index reach = std::min({half, i, values.size() - 1 - i});
    result[i] = values.segment(i - reach, 2 * reach + 1).mean();
  }
  return result;
}

}  // namespace

std::string proposed_scenario(const std::string& answer_directory) {
  const auto document = recording::read_json_object((fs::path(answer_directory) / "diagnosis.json").string());
  if (!document.contains("alternatives")) return {};
  for (const auto& other : document["alternatives"]) {
    if (!other.contains("separating_experiment") || !other["separating_experiment"].is_string()) continue;
    std::istringstream words(other["separating_experiment"].get<std::string>());
    for (std::string word; words >> word;) {
      while (!word.empty() && std::string("\"'`.,;:()").find(word.back()) != std::string::npos)
        word.pop_back();
      while (!word.empty() && std::string("\"'`(").find(word.front()) != std::string::npos) word.erase(0, 1);
      if (!word.ends_with(".toml")) continue;
      const fs::path path = fs::path(answer_directory) / word;
      if (fs::exists(path)) return path.string();
    }
  }
  return {};
}

std::optional<concealed::Excitation> inputs_of(const std::string& recording_path,
                                               const concealed::Instrument& unit) {
  const auto file = recording::read_recording(recording_path);
  const auto* time = file.find("time_s");
  if (time == nullptr || file.find("case_temp_degc") == nullptr) return std::nullopt;
  // Whole blocks of 20 s, which the writer's measure of d' counts in.
  const auto seconds =
      static_cast<Eigen::Index>(std::floor((time->values.back() - time->values.front()) / 20.0)) * 20;
  if (seconds < kShortest_s) return std::nullopt;
  const auto series = [&](const char* name, double absent) -> Series {
    const auto* channel = file.find(name);
    if (channel == nullptr) return Series::Constant(seconds, absent);
    return each_second(time->values, channel->values, seconds);
  };
  concealed::Excitation in;
  in.program = "proposed";
  in.time_s = Series::LinSpaced(seconds, 0.0, static_cast<double>(seconds - 1));
  in.case_degc = smoothed(series("case_temp_degc", 20.0), 30);
  in.case_ahead_degc = concealed::later(in.case_degc, 0.5 - unit.nuisance.lag_s);
  in.board_degc = concealed::lagged(in.case_degc, unit.board_lag_s, in.case_degc[0]) + unit.board_rise_degc;
  if (file.find("board_temp_degc") != nullptr) {
    const Series over_case = smoothed(series("board_temp_degc", 25.0), 30) - in.case_degc;
    in.board_degc += over_case - over_case.head(kAtStart_s).mean();
  }
  in.rate_in_dph = series("rate_in_dph", 0.0);
  in.accel_g = series("accel_g", 0.0);
  const Series supply = series("supply_v", 150.0);
  in.supply_v = supply * (150.0 / (supply[0] != 0.0 ? supply[0] : 1.0));
  in.trim_v = series("quadrature_trim_v", 0.0);
  // Measured, with a noise of 1e-5 that the amplitude's own steps are far above.
  in.amplitude = (series("amplitude", 1.0) * 1e3).round() / 1e3;
  in.power = Series::Ones(seconds);
  in.stimuli = concealed::kRich;
  return in;
}

}  // namespace hemi::prove

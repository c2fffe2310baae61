// SPDX-License-Identifier: Apache-2.0
#include "cli/untestable.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "golden/physics/effect.hpp"

namespace hemi::cli {
namespace {

// Channels that an effect is seen by, and the input that has to move.
struct Need {
  std::vector<std::string> channels;
  std::string moving;
  bool single_rows = false;  // hidden by averaging
};

const std::map<std::string, Need>& needs() {
  static const std::string kCase = "case_temp_degc", kBoard = "board_temp_degc", kHz = "frequency_hz",
                           kDrive = "drive_v", kQuadrature = "quadrature_v", kRate = "rate_dph",
                           kIn = "rate_in_dph", kAmplitude = "amplitude", kAccel = "accel_g",
                           kSupply = "supply_v";
  static const std::map<std::string, Need> kNeeds = {
      {"thermal_second_time_constant", {{kCase, kHz}, kCase}},
      {"thermal_gradient_bias", {{kRate}, kCase}},
      {"thermal_hysteresis", {{kRate}, kCase}},
      {"frequency_polynomial_order", {{kCase, kHz}, kCase}},
      {"frequency_ageing", {{kCase, kHz}, ""}},
      {"oscillator_temperature", {{kCase, kHz, kBoard}, kBoard}},
      {"oscillator_ageing", {{kCase, kHz}, ""}},
      {"duffing", {{kCase, kHz, kAmplitude}, kAmplitude}},
      {"damping_nonlinearity", {{kDrive, kAmplitude}, kAmplitude}},
      {"electrostatic_softening", {{kCase, kHz, kSupply}, kSupply}},
      {"self_heating", {{kCase, kHz}, ""}},
      {"gas_leak", {{kDrive}, ""}},
      {"damping_temperature", {{kDrive}, kCase}},
      {"damping_anisotropy", {{kRate, kDrive}, ""}},
      {"forcer_misalignment", {{kRate, kDrive}, ""}},
      {"frequency_split", {{kQuadrature}, ""}},
      {"demodulation_phase", {{kRate, kQuadrature}, ""}},
      {"pickoff_gain", {{kDrive, kBoard}, kBoard}},
      {"pll_lag", {{kCase, kHz}, kCase}},
      {"scale_factor_temperature", {{kRate, kIn}, kIn}},
      {"scale_factor_nonlinearity", {{kRate, kIn}, kIn}},
      {"earth_rate", {{kRate, kAccel}, kAccel}},
      {"g_sensitivity", {{kRate, kAccel}, kAccel}},
      {"rate_flicker", {{kRate}, ""}},
      {"rate_random_walk", {{kRate}, ""}},
      {"cycle_slip", {{kHz}, "", true}},
      {"sample_loss", {{}, "", true}},
      {"time_shift", {{}, ""}},
      {"interference", {{}, "", true}},
      {"aliased_carrier", {{}, "", true}}};
  return kNeeds;
}

std::string reason(const std::string& id, const DiagnosisInput& input, bool tested) {
  const auto found = needs().find(id);
  if (found == needs().end()) return "shows in raw samples or on a bench, not in telemetry";
  const Need& need = found->second;
  std::vector<std::string> missing;
  for (const auto& channel : need.channels)
    if (std::ranges::find(input.absent, channel) != input.absent.end()) missing.push_back(channel);
  if (!missing.empty()) return fmt::format("not recorded: {}", fmt::join(missing, ", "));
  if (need.single_rows) return input.averaged_rows > 1 ? "rows were averaged" : "";
  if (tested) return "";
  return need.moving.empty() ? "" : fmt::format("{} hardly moves", need.moving);
}

}  // namespace

std::vector<Untestable> untestable(const DiagnosisInput& input, const std::vector<std::string>& tested) {
  std::vector<Untestable> list;
  for (const auto& [id, entry] : physics::catalogue()) {
    const std::string why = reason(id, input, std::ranges::find(tested, id) != tested.end());
    if (!why.empty()) list.push_back({id, why});
  }
  return list;
}

std::string untestable_text(const recording::Json& list) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const auto& entry : list)
    by_reason[entry["why"].get<std::string>()].push_back(entry["id"].get<std::string>());
  std::string text = by_reason.empty() ? "" : "this recording cannot show:\n";
  for (const auto& [why, ids] : by_reason) text += fmt::format("  {}: {}\n", why, fmt::join(ids, ", "));
  return text;
}

}  // namespace hemi::cli

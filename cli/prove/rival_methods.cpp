// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/rival_methods.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "cli/recording/error.hpp"
#include "cli/recording/model.hpp"
#include "cli/recording/recording.hpp"
#include "golden/rivals/methods.hpp"

namespace hemi::prove {
namespace {

constexpr int kAverage = 20;  // samples; keeps the steps of the stimuli, and white noise white

rivals::Telemetry telemetry(const recording::Recording& file) {
  const auto series = [&](const char* name) -> Eigen::VectorXd {
    const auto* channel = file.find(name);
    if (channel == nullptr) return {};
    return Eigen::Map<const Eigen::VectorXd>(channel->values.data(),
                                             static_cast<Eigen::Index>(channel->values.size()));
  };
  rivals::Telemetry in;
  in.step_s = 1.0 / file.sample_rate_hz;
  in.time_s = series("time_s");
  in.case_degc = series("case_temp_degc");
  in.board_degc = series("board_temp_degc");
  in.rate_in_dph = series("rate_in_dph");
  in.accel_g = series("accel_g");
  in.supply_v = series("supply_v");
  in.trim_v = series("quadrature_trim_v");
  in.frequency_hz = series("frequency_hz");
  in.amplitude = series("amplitude");
  in.drive_v = series("drive_v");
  in.quadrature_v = series("quadrature_v");
  in.rate_dph = series("rate_dph");
  return in;
}

rivals::Numbers numbers(const recording::InstrumentModel& model) {
  if (!model.frequency || !model.bias || !model.drive || !model.quadrature || !model.thermal_time_constant_s)
    throw recording::InputError({model.path}, "lacks a part that the comparison needs",
                                "give frequency, thermal, bias, drive and quadrature");
  rivals::Numbers n;
  n.frequency_reference_degc = model.frequency->reference_degc;
  n.frequency_hz = model.frequency->coefficients_hz;
  n.time_constant_s = *model.thermal_time_constant_s;
  n.bias_reference_hz = model.bias->reference_hz;
  n.bias_dph = model.bias->terms_dph;
  n.scale_factor = model.scale_factor;
  n.drive_reference_degc = model.drive->reference_degc;
  n.drive_v = model.drive->coefficients_v;
  n.quadrature_reference_degc = model.quadrature->reference_degc;
  n.quadrature_v = model.quadrature->coefficients_v;
  return n;
}

Answer answer(const rivals::Names& names) {
  Answer said;
  said.names_only = true;
  said.verdict = names.empty() ? "consistent" : "named";
  if (names.size() == 1 && names.front() == "unknown") said.verdict = "unknown";
  for (const auto& id : names) {
    Named effect;
    effect.id = id;
    said.effects.push_back(std::move(effect));
  }
  return said;
}

}  // namespace

std::map<std::string, Answer> rival_answers(const std::string& recording_path,
                                            const std::string& model_path) {
  const auto problems = rivals::problems(telemetry(recording::read_recording(recording_path)),
                                         numbers(recording::read_model(model_path)), kAverage);
  return {{"stepwise F/BIC", answer(rivals::stepwise(problems))},
          {"STLSQ", answer(rivals::sparse(problems))},
          {"Gaussian process", answer(rivals::gaussian_process(problems))},
          {"polynomial(T)", answer(rivals::polynomial(problems))}};
}

}  // namespace hemi::prove

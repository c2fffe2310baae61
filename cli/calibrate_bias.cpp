// SPDX-License-Identifier: Apache-2.0
// Scale factor and drift model over Eq. (21), and how far they carry.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/calibrate.hpp"
#include "cli/recording/error.hpp"
#include "golden/calibration/compensation_score.hpp"
#include "golden/calibration/drift_terms.hpp"
#include "golden/calibration/linear_fit.hpp"
#include "golden/calibration/voltage_fit.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

using hemi::calibration::kDriftTerms;
using recording::InputError;
using recording::InstrumentModel;

/// Below it the turntable's rates say less than the nominal 1.
constexpr double largest_scale_error = 1e-3;
/// Between the settled state and a warming or cooling one [Hz/s]: about 2 degC an hour.
constexpr double moving_hz_per_s = 2e-4;

/// Largest difference that rounding the ten coefficients to the registers' formats makes over the rows fitted
/// [deg/h].
double rounding_error_dph(const InstrumentModel& model, const DriftData& data, const Setup& setup) {
  const auto image = tb::to_image(setup.values);
  double difference[10];
  for (int k = 0; k < 10; ++k) {
    const int r = config::reg_bias_0 + k;
    difference[k] = tb::to_value(image[r], config::registers[r].format) - setup.values[r];
  }
  double largest = 0.0;
  for (Eigen::Index i = 0; i < data.time_s.size(); ++i) {
    const double o = (data.samples.frequency_hz[i] - model.bias->reference_hz) / config::offset_span_hz;
    const double g = data.samples.slope_hz_per_s[i] / derivative_full_scale_hz_per_s;
    const double powers[10] = {1, o, o * o, o * o * o, g, g * g, g * g * g, o * g, o * o * g, o * g * g};
    double sum = 0.0;
    for (int k = 0; k < 10; ++k) sum += difference[k] * powers[k];
    largest = std::max(largest, std::abs(sum));
  }
  return largest;
}

std::string scores_text(const DriftScores& scores, int blocks) {
  std::string text = fmt::format("rms of the rate [deg/h]    in sample   {} blocks held out\n", blocks);
  text += fmt::format("  Eq. (21) stepwise       {:>12.4f}   {:>12.4f}\n", scores.stepwise.in_sample_rms,
                      scores.stepwise.held_out_rms);
  text += fmt::format("  plain cubic in f        {:>12.4f}   {:>12.4f}\n", scores.cubic.in_sample_rms,
                      scores.cubic.held_out_rms);
  if (scores.stepwise.held_out_rms > scores.cubic.held_out_rms) {
    text +=
        "  Held out, the stepwise model is worse than the plain cubic: what it gains in sample does not "
        "carry over.\n";
  }
  return text;
}

void score_blocks_of(const DriftData& data, double reference_hz, Calibration& calibration) {
  const int blocks = calibration.options.blocks;
  if (blocks < 2) return;
  const DriftScores scores = score_drift(data, reference_hz, blocks);
  calibration.text += scores_text(scores, blocks);
  calibration.json["scores"] = {
      {"blocks", blocks},
      {"stepwise",
       {{"in_sample_rms_dph", scores.stepwise.in_sample_rms},
        {"held_out_rms_dph", scores.stepwise.held_out_rms}}},
      {"cubic",
       {{"in_sample_rms_dph", scores.cubic.in_sample_rms}, {"held_out_rms_dph", scores.cubic.held_out_rms}}}};
}

void calibrate_scale(DriftData& data, double reference_hz, Calibration& calibration) {
  auto& model = calibration.model;
  const double span = data.applied_dph.maxCoeff() - data.applied_dph.minCoeff();
  if (!(span > 0.0)) {
    calibration.text += fmt::format(
        "scale factor {} (the applied rate does not change, so it was not fitted)\n", model.scale_factor);
    return;
  }
  const Eigen::VectorXd offset = data.samples.frequency_hz.array() - reference_hz;
  const auto fit = hemi::calibration::fit_scale(
      data.applied_dph, hemi::calibration::drift_design(offset, data.samples.slope_hz_per_s),
      data.raw_rate_dph, data.samples.segments);
  if (!(fit.standard_error < largest_scale_error)) {
    calibration.text += fmt::format(
        "scale factor {} (the applied rates would give {:.4f} +- {:.2g}, which says too little)\n",
        model.scale_factor, fit.scale, fit.standard_error);
    return;
  }
  model.scale_factor = fit.scale;
  calibration.json["scale_factor"] = {{"value", fit.scale}, {"standard_error", fit.standard_error}};
  calibration.text +=
      fmt::format("scale factor {:.8f} (standard error {:.2g}), rates from {:.6g} to {:.6g} deg/h\n",
                  fit.scale, fit.standard_error, data.applied_dph.minCoeff(), data.applied_dph.maxCoeff());
  data.apply_scale(fit.scale);
}

std::string survivors_text(const hemi::calibration::BiasRegression& fit) {
  // Eq. (22): all of Eq. (21) but f^2 f' and f f'^2.
  std::string here, paper;
  for (std::size_t k = 0; k < kDriftTerms.size(); ++k) {
    const std::string name(kDriftTerms[k].name);
    const std::string blank(name.size(), '-');
    here += " " + (fit.selected(k) ? name : blank);
    paper += " " + (name != "f^2*df" && name != "f*df^2" ? name : blank);
  }
  return fmt::format("terms that survive  here    {}\n                    Eq. (22){}\n", here, paper);
}

double reference_of(const Calibration& calibration) {
  const auto& model = calibration.model;
  if (calibration.options.reference_hz) return *calibration.options.reference_hz;
  if (model.bias) return model.bias->reference_hz;
  double reference_hz = 0.0;
  const auto& c = model.frequency->coefficients_hz;
  for (auto k = c.rbegin(); k != c.rend(); ++k)
    reference_hz = reference_hz * (20.0 - model.frequency->reference_degc) + *k;
  return reference_hz;
}

void report_fit(const DriftData& data, const hemi::calibration::BiasRegression& fit,
                const std::vector<recording::Recording>& recordings, Calibration& calibration) {
  auto& model = calibration.model;
  std::size_t rows = 0;
  std::string paths;
  for (const auto& recording : recordings) {
    rows += recording.rows();
    paths += (paths.empty() ? "" : ", ") + recording.path;
  }
  calibration.text += fmt::format("{}: {} rows, {} of them usable; df/dt over {:.4g} s, centred{}\n{}{}",
                                  paths, rows, data.time_s.size(), data.derivative_window_s,
                                  recordings.front().find("frequency_hz") == nullptr
                                      ? "; f(T) of the case stands in for the frequency"
                                      : "",
                                  fit.report(), survivors_text(fit));
  const Setup setup = telemetry_setup(recordings.front().sample_rate_hz, model, calibration.options.window_s);
  const double rounding = rounding_error_dph(model, data, setup);
  calibration.text += fmt::format(
      "rounded to the core's registers, B moves by at most {:.2g} deg/h over these rows\n", rounding);
  auto& json = calibration.json["bias"];
  json = {{"reference_hz", fit.reference_hz},
          {"rows", data.time_s.size()},
          {"effective_samples", fit.effective_samples},
          {"derivative_window_s", data.derivative_window_s},
          {"core_lag_s", data.lag_s},
          {"register_rounding_dph", rounding}};
  for (const auto& term : fit.terms) {
    json["terms"].push_back({{"term", kDriftTerms[term.term].name},
                             {"coefficient", term.coefficient},
                             {"standard_error", term.standard_error},
                             {"f", term.f_statistic},
                             {"p", term.p_value},
                             {"proven", term.proven}});
  }
}

void score_one(const std::string& path, Calibration& calibration) {
  const auto recording = recording::read_recording(path);
  refuse_compensated(recording, "scoring");
  const auto& model = calibration.model;
  const DriftData data = drift_data(recording, model, -std::numeric_limits<double>::infinity(),
                                    std::numeric_limits<double>::infinity(), calibration.options.window_s);
  // As the core compensates: df/dt with the lag that it has there.
  Eigen::VectorXd after = data.samples.rate_dph;
  for (Eigen::Index i = 0; i < after.size(); ++i) {
    for (std::size_t k = 0; k < kDriftTerms.size(); ++k)
      after[i] -= model.bias->terms_dph[k] *
                  kDriftTerms[k].value(data.samples.frequency_hz[i] - model.bias->reference_hz,
                                       data.core_slope_hz_per_s[i]);
  }
  calibration.text += fmt::format(
      "held out: {}, bias stability [deg/h], df/dt {:.1f} s late as in the core\n", path, data.lag_s);
  for (const double average_s : {10.0, 100.0}) {
    const auto score = hemi::calibration::score_compensation(
        data.samples.rate_dph, after, data.samples.slope_hz_per_s, data.samples.segments, data.interval_s,
        average_s, moving_hz_per_s);
    recording::Json json = {{"recording", path}, {"average_s", average_s}};
    const auto line = [&](const char* name, const hemi::calibration::StabilityPair& pair) {
      if (pair.averages == 0) return;
      calibration.text +=
          fmt::format("  {:>4.0f} s averages  {:<8} {:>9.4f} -> {:>8.4f}   {:>7.2f} times  ({} averages)\n",
                      average_s, name, pair.before_dph, pair.after_dph, pair.factor(), pair.averages);
      json[name] = {
          {"before_dph", pair.before_dph}, {"after_dph", pair.after_dph}, {"averages", pair.averages}};
    };
    line("all", score.all);
    line("warming", score.warming);
    line("cooling", score.cooling);
    line("settled", score.settled);
    calibration.json["held_out"].push_back(json);
  }
}

}  // namespace

std::optional<DriftData> calibrate_bias(const std::vector<recording::Recording>& recordings,
                                        Calibration& calibration) {
  auto& model = calibration.model;
  std::vector<DriftData> parts;
  std::vector<std::string> paths;
  std::vector<recording::Recording> used;
  for (const auto& recording : recordings) {
    if (recording.find("rate_dph") == nullptr) continue;
    parts.push_back(drift_data(recording, model, calibration.options.from_s, calibration.options.to_s,
                               calibration.options.window_s));
    paths.push_back(recording.path);
    used.push_back(recording);
  }
  if (parts.empty()) {
    calibration.leave_out("bias", "no recording has the channel rate_dph");
    return std::nullopt;
  }
  DriftData data = join(parts, paths);
  print_notes(data.notes);
  const double reference_hz = reference_of(calibration);
  calibrate_scale(data, reference_hz, calibration);
  const auto fit = hemi::calibration::fit_bias(data.samples, reference_hz);
  model.bias = recording::BiasModel{reference_hz, {}};
  for (std::size_t i = 0; i < fit.coefficients.size(); ++i) model.bias->terms_dph[i] = fit.coefficients[i];
  model.document["bias"]["derivative_window_s"] = data.derivative_window_s;
  report_fit(data, fit, used, calibration);
  score_blocks_of(data, reference_hz, calibration);
  return data;
}

void score_heldout(Calibration& calibration) {
  for (const auto& path : calibration.options.heldout) {
    if (!calibration.model.bias) {
      throw InputError({path}, "is held out, but there is no drift model to score",
                       "give a recording with rate_dph to fit, or --base with a model that has one");
    }
    score_one(path, calibration);
  }
}

}  // namespace hemi::cli

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cli/commands.hpp"
#include "cli/drift_data.hpp"
#include "cli/options.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/raw_capture.hpp"
#include "cli/recording/write.hpp"
#include "golden/calibration/linear_fit.hpp"
#include "golden/calibration/order_study.hpp"
#include "golden/calibration/settled_points.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

using recording::InputError;
using recording::InstrumentModel;

struct CalibrateOptions {
  std::vector<std::string> inputs;
  std::string base;
  std::string output;
  std::optional<int> order;
  double reference_degc = 0.0;
  std::optional<double> reference_hz;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  std::optional<double> window_s;
  int blocks = 8;
  bool json = false;
};

// ---- f(T)
// -----------------------------------------------------------------------------------------------------

std::string frequency_text(const calibration::FrequencyFit& fit, const calibration::SettledPoints& points,
                           const Eigen::VectorXd& leave_one_out) {
  const auto& p = fit.polynomial;
  std::string text = fmt::format("f(T) of order {} about {} degC, {} points\n", p.order(), p.reference_degc(),
                                 points.frequency_hz.size());
  for (Eigen::Index i = 0; i <= p.order(); ++i) {
    text += fmt::format("  a{} = {:+.9g} Hz/degC^{}  (standard error {:.2g})\n", i, p.coefficients_hz()[i], i,
                        fit.standard_errors[i]);
  }
  text += fmt::format("  largest residual {:.4f} Hz; {} over {} to {} degC\n", fit.max_residual_hz,
                      p.monotone() ? "monotonic" : "NOT monotonic", p.min_degc(), p.max_degc());
  text += "  settled degC    frequency Hz   degC from f     error   left out\n";
  for (Eigen::Index i = 0; i < points.frequency_hz.size(); ++i) {
    const double t = points.temperature_degc[i];
    std::string back = "         -         -";
    try {
      const double read = p.temperature_degc(points.frequency_hz[i]);
      back = fmt::format("{:>11.4f} {:>9.4f}", read, read - t);
    } catch (const std::domain_error&) {
      // Not invertible there: the column stays open, the line above says that f(T) is not monotonic.
    }
    text +=
        fmt::format("  {:>12.3f} {:>15.4f} {} {:>10.4f}\n", t, points.frequency_hz[i], back,
                    leave_one_out.size() > 0 ? leave_one_out[i] : std::numeric_limits<double>::quiet_NaN());
  }
  return text;
}

void calibrate_frequency(const std::string& path, const CalibrateOptions& options, InstrumentModel& model,
                         std::string& text, recording::Json& json) {
  const auto points = calibration::read_settled_points(path, options.order.value_or(1));
  const auto study = calibration::study_order(points, options.reference_degc);
  const Eigen::Index order = options.order ? *options.order : study.chosen;
  const auto fit = calibration::fit_frequency(points, order, options.reference_degc);
  text += frequency_text(fit, points, calibration::leave_one_out_degc(points, order, options.reference_degc));
  if (!options.order)
    text += study.verdict + (study.verdict.empty() || study.verdict.back() == '\n' ? "" : "\n");
  const auto& c = fit.polynomial.coefficients_hz();
  model.frequency = recording::FrequencyModel{options.reference_degc, {c.data(), c.data() + c.size()}};
  model.document["frequency"]["calibrated_degc"] = {points.temperature_degc.minCoeff(),
                                                    points.temperature_degc.maxCoeff()};
  json["frequency"] = {{"order", order},
                       {"reference_degc", options.reference_degc},
                       {"coefficients_hz", model.frequency->coefficients_hz},
                       {"max_residual_hz", fit.max_residual_hz},
                       {"chosen_order", study.chosen},
                       {"verdict", study.verdict}};
}

// ---- bias
// -----------------------------------------------------------------------------------------------------

/// Largest difference that rounding the ten coefficients to the registers' formats makes over the rows fitted
/// [deg/h].
double rounding_error_dph(const InstrumentModel& model, const DriftData& data, const Setup& setup) {
  const auto image = tb::to_image(setup.values);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < data.time_s.size(); ++i) {
    const double o = (data.samples.frequency_hz[i] - model.bias->reference_hz) / config::offset_span_hz;
    const double g = data.samples.slope_hz_per_s[i] / derivative_full_scale_hz_per_s;
    const double powers[10] = {1, o, o * o, o * o * o, g, g * g, g * g * g, o * g, o * o * g, o * g * g};
    double difference = 0.0;
    for (int k = 0; k < 10; ++k) {
      const int r = config::reg_bias_0 + k;
      difference += (tb::to_value(image[r], config::registers[r].format) - setup.values[r]) * powers[k];
    }
    largest = std::max(largest, std::abs(difference));
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

void calibrate_bias(const std::string& path, const CalibrateOptions& options, InstrumentModel& model,
                    std::string& text, recording::Json& json) {
  if (recording::is_raw(path)) {
    throw InputError({path}, "is a raw capture, where settled points or a chamber recording are expected",
                     "run it through an engine first: hemi run");
  }
  if (!model.frequency) {
    throw InputError(
        {path}, "a drift model needs f(T)",
        "give settled points first (CSV settled_degc,frequency_hz), or --base with a model that has them");
  }
  check_stretch(options.from_s, options.to_s);
  const auto recording = recording::read_recording(path);
  const auto frequency = recording.find("frequency_hz");
  double reference_hz = 0.0;
  if (options.reference_hz)
    reference_hz = *options.reference_hz;
  else if (model.bias)
    reference_hz = model.bias->reference_hz;
  else {
    const auto& c = model.frequency->coefficients_hz;
    for (auto k = c.rbegin(); k != c.rend(); ++k)
      reference_hz = reference_hz * (20.0 - model.frequency->reference_degc) + *k;
  }
  const DriftData data = drift_data(recording, model, options.from_s, options.to_s, options.window_s);
  for (const auto& note : data.notes) fmt::print(stderr, "note: {}\n", note);
  const auto fit = calibration::fit_bias(data.samples, reference_hz);
  model.bias = recording::BiasModel{reference_hz, {}};
  for (std::size_t i = 0; i < fit.coefficients.size(); ++i) model.bias->terms_dph[i] = fit.coefficients[i];
  model.document["bias"]["derivative_window_s"] = data.derivative_window_s;
  if (!recording.device.empty()) model.device = recording.device;
  text +=
      fmt::format("\n{}: {} rows, {} of them usable; df/dt over {:.4g} s{}\n{}", path, recording.rows(),
                  data.time_s.size(), data.derivative_window_s,
                  frequency == nullptr ? "; f(T) of the case stands in for the frequency" : "", fit.report());
  const Setup setup = telemetry_setup(recording.sample_rate_hz, model, options.window_s);
  const double rounding = rounding_error_dph(model, data, setup);
  text += fmt::format("rounded to the core's registers, B moves by at most {:.2g} deg/h over these rows\n",
                      rounding);
  json["bias"] = {{"reference_hz", reference_hz},
                  {"rows", data.time_s.size()},
                  {"effective_samples", fit.effective_samples},
                  {"register_rounding_dph", rounding}};
  for (const auto& term : fit.terms) {
    json["bias"]["terms"].push_back({{"term", calibration::kDriftTerms[term.term].name},
                                     {"coefficient", term.coefficient},
                                     {"standard_error", term.standard_error},
                                     {"f", term.f_statistic},
                                     {"p", term.p_value}});
  }
  if (options.blocks < 2) return;
  const DriftScores scores = score_drift(data, reference_hz, options.blocks);
  text += scores_text(scores, options.blocks);
  json["scores"] = {
      {"blocks", options.blocks},
      {"stepwise",
       {{"in_sample_rms_dph", scores.stepwise.in_sample_rms},
        {"held_out_rms_dph", scores.stepwise.held_out_rms}}},
      {"cubic",
       {{"in_sample_rms_dph", scores.cubic.in_sample_rms}, {"held_out_rms_dph", scores.cubic.held_out_rms}}}};
}

/// What the numbers of a file do not allow (too few different temperatures, a regressor that does not move)
/// is bad input, told with the file's name.
template <class Work>
void on_data(const std::string& path, Work work) {
  constexpr const char* remedy =
      "check the units, --reference-degc and --reference-hz, or record a wider range";
  try {
    work();
  } catch (const std::invalid_argument& error) {
    throw InputError({path}, error.what(), remedy);
  } catch (const std::domain_error& error) {
    throw InputError({path}, error.what(), remedy);
  } catch (const calibration::RankDeficiencyError& error) {
    throw InputError({path}, error.what(), remedy);
  }
}

int calibrate(const CalibrateOptions& options) {
  refuse_overwriting({options.output}, options.inputs);
  InstrumentModel model;
  if (!options.base.empty()) model = recording::read_model(options.base);
  std::string text;
  recording::Json json;
  std::vector<std::string> recordings;
  for (const auto& path : options.inputs) {
    if (!holds_settled_points(path))
      recordings.push_back(path);
    else
      on_data(path, [&] { calibrate_frequency(path, options, model, text, json); });
  }
  if (recordings.size() > 1) {
    throw InputError({recordings[1]}, "a drift model is fitted to one recording, and this is the second",
                     "give settled points and one chamber recording");
  }
  for (const auto& path : recordings)
    on_data(path, [&] { calibrate_bias(path, options, model, text, json); });
  if (!options.output.empty()) {
    recording::write_model(options.output, model);
    text += fmt::format("wrote {}\n", options.output);
    json["model"] = options.output;
  }
  if (options.json)
    fmt::print("{}\n", recording::json_text(json, 2));
  else
    fmt::print("{}", text);
  return exit_good;
}

}  // namespace

void add_calibrate(CLI::App& app, Job& job) {
  auto options = std::make_shared<CalibrateOptions>();
  auto* command = app.add_subcommand(
      "calibrate", "Settled points and a chamber recording to f(T), drift model and instrument model");
  command
      ->add_option("inputs", options->inputs,
                   "settled points (CSV settled_degc,frequency_hz) and/or one chamber recording "
                   "(frequency_hz, rate_dph)")
      ->required();
  command->add_option("-o,--output", options->output, "instrument model to write (M.model.json)");
  command->add_option("--base", options->base, "instrument model to start from");
  command
      ->add_option("--order", options->order,
                   "order of f(T); default: what the points support, with the reasons")
      ->check(CLI::Range(1, 8));
  command
      ->add_option("--reference-degc", options->reference_degc,
                   "temperature that f(T) is expanded about [degC]")
      ->check(number_between(-273.15, 1000.0))
      ->capture_default_str();
  command
      ->add_option("--reference-hz", options->reference_hz,
                   "frequency that the drift model is expanded about [Hz]; default: that at 20 degC")
      ->check(positive_number());
  command->add_option("--from", options->from_s, "start of the stretch to fit [s]");
  command->add_option("--to", options->to_s, "end of it [s]");
  command->add_option("--window", options->window_s, "window of df/dt [s], about; default 20")
      ->check(positive_number());
  command->add_option("--blocks", options->blocks, "contiguous blocks for held-out scores; 0 for none")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "result as JSON");
  command->footer(
      "Example: hemi calibrate tests/data/paper_table1.csv --order 3 -o hrg.model.json\n"
      "         hemi calibrate chamber.csv --base hrg.model.json --to 12000 -o hrg.model.json");
  command->callback([options, &job] { job = [options] { return calibrate(*options); }; });
}

}  // namespace hemi::cli

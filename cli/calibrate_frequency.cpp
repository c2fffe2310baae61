// SPDX-License-Identifier: Apache-2.0
// f(T) from a file of settled points.
#include <fmt/format.h>

#include <cmath>

#include "cli/calibrate.hpp"
#include "golden/calibration/order_study.hpp"
#include "golden/calibration/settled_points.hpp"

namespace hemi::cli {
namespace {

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

}  // namespace

void calibrate_frequency(const std::string& path, Calibration& calibration) {
  const CalibrateOptions& options = calibration.options;
  recording::InstrumentModel& model = calibration.model;
  std::string& text = calibration.text;
  const auto points = hemi::calibration::read_settled_points(path, options.order.value_or(1));
  const auto study = hemi::calibration::study_order(points, options.reference_degc);
  const Eigen::Index order = options.order ? *options.order : study.chosen;
  const auto fit = hemi::calibration::fit_frequency(points, order, options.reference_degc);
  text += frequency_text(fit, points,
                         hemi::calibration::leave_one_out_degc(points, order, options.reference_degc));
  if (!options.order)
    text += study.verdict + (study.verdict.empty() || study.verdict.back() == '\n' ? "" : "\n");
  const auto& c = fit.polynomial.coefficients_hz();
  model.frequency = recording::FrequencyModel{options.reference_degc, {c.data(), c.data() + c.size()}};
  model.document["frequency"]["calibrated_degc"] = {points.temperature_degc.minCoeff(),
                                                    points.temperature_degc.maxCoeff()};
  calibration.json["frequency"] = {{"order", order},
                                   {"reference_degc", options.reference_degc},
                                   {"coefficients_hz", model.frequency->coefficients_hz},
                                   {"max_residual_hz", fit.max_residual_hz},
                                   {"chosen_order", study.chosen},
                                   {"verdict", study.verdict}};
}

}  // namespace hemi::cli

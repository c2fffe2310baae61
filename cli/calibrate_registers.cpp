// SPDX-License-Identifier: Apache-2.0
// The register image that a model makes, as JSON, C header or memory file.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "cli/calibrate.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/write.hpp"
#include "cli/register_image.hpp"
#include "cli/scenario/model_instrument.hpp"
#include "golden/loops/control.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

/// Largest difference between f(T)'s inverse and the thermometer with its rounded coefficients.
double thermometer_error_degc(const recording::InstrumentModel& model, const tb::RegisterImage& image) {
  const auto polynomial = frequency_polynomial(model);
  const auto stored = [&](int r) { return tb::to_value(image[r], config::registers[r].format); };
  constexpr int points = 501;
  double largest = 0.0;
  for (int i = 0; i < points; ++i) {
    const double degc =
        polynomial.min_degc() + (polynomial.max_degc() - polynomial.min_degc()) * i / (points - 1);
    const double offset =
        (polynomial.frequency_hz(degc) - stored(config::reg_frequency_reference)) / config::offset_span_hz;
    double read = 0.0;
    for (int k = 5; k >= 0; --k) read = read * offset + stored(config::reg_thermometer_0 + k);
    largest = std::max(largest, std::abs(read - degc));
  }
  return largest;
}

}  // namespace

Setup core_setup(const recording::InstrumentModel& model, std::optional<double> window_s) {
  recording::RawCapture nominal;
  nominal.sample_rate_hz = sampling(false).adc_rate_hz;
  nominal.full_scale_lsb = std::ldexp(1.0, sampling(false).adc_bits - 1);
  Setup setup = capture_setup(nominal, &model, std::nullopt, window_s);
  // The loops are those of the nominal instrument with this model's frequency, drive and quadrature.
  loops::set_control(setup.values, scenario::instrument_of(model, physics::Instrument{}, {}),
                     loops::CoreSampling::reference());
  return setup;
}

void write_registers(const std::string& path, Calibration& calibration) {
  const auto& model = calibration.model;
  if (!model.frequency) {
    throw recording::InputError({path}, "a register image needs f(T)",
                                "give settled points, chamber recordings or --base with a model that has it");
  }
  const Setup setup = core_setup(model, calibration.options.window_s);
  const auto image = tb::to_image(setup.values);
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".json")
    recording::write_text(path, image_as_json(image, setup.values, model.device));
  else if (extension == ".h")
    recording::write_text(path, image_as_c(image, model.device));
  else if (extension == ".mem")
    recording::write_text(path, image_as_memory(image));
  else
    throw recording::InputError({path}, "no form of register image has this extension",
                                "name it .json, .h or .mem");
  const double error_degc = thermometer_error_degc(model, image);
  calibration.text += fmt::format(
      "wrote {}: {} registers; the thermometer with rounded coefficients is within {:.2g} degC of f(T)\n",
      path, int{config::register_count}, error_degc);
  calibration.json["registers"] = {{"path", path}, {"thermometer_error_degc", error_degc}};
}

}  // namespace hemi::cli

// SPDX-License-Identifier: Apache-2.0
// The register image that a model makes, as JSON, C header or memory file.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "cli/calibrate.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/write.hpp"
#include "cli/scenario/model_instrument.hpp"
#include "golden/loops/control.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

constexpr int image_bits = 54;  ///< the widest register: all words of a memory file have that width

std::uint64_t word_of(std::int64_t raw, int bits) {
  return static_cast<std::uint64_t>(raw) & ((std::uint64_t{1} << bits) - 1);
}

std::string hex_of(std::int64_t raw, int bits) {
  return fmt::format("{:0{}x}", word_of(raw, bits), (bits + 3) / 4);
}

std::string as_json(const Setup& setup, const tb::RegisterImage& image, const std::string& device) {
  recording::Json json = {{"format", "hemi-registers/1"}, {"device", device}};
  for (int i = 0; i < config::register_count; ++i) {
    const auto& r = config::registers[i];
    const double stored = tb::to_value(image[i], r.format);
    recording::Json entry = {{"index", i},
                             {"name", r.name},
                             {"value", stored},
                             {"unit", r.unit},
                             {"raw", image[i]},
                             {"hex", hex_of(image[i], r.format.width)},
                             {"width", r.format.width},
                             {"fraction", r.format.fraction},
                             {"meaning", r.meaning}};
    if (i != config::reg_parity) entry["rounding_error"] = stored - setup.values[i];
    json["registers"].push_back(entry);
  }
  return recording::json_text(json, 2) + "\n";
}

std::string as_header(const tb::RegisterImage& image, const std::string& device) {
  std::string text = fmt::format(
      "/* Register image of {}: raw words, value = raw * 2^-fraction. Made by hemi calibrate. */\n"
      "#ifndef HEMI_REGISTER_IMAGE_H\n#define HEMI_REGISTER_IMAGE_H\n\n#include <stdint.h>\n\n",
      device.empty() ? "one instrument" : device);
  // A name from a file must not end the comment.
  for (std::size_t at = text.find("*/"); at != text.rfind("*/"); at = text.find("*/"))
    text.replace(at, 2, "* ");
  text += fmt::format("#define HEMI_REGISTER_COUNT {}\n\n", int{config::register_count});
  text += "static const int64_t hemi_register_image[HEMI_REGISTER_COUNT] = {\n";
  for (int i = 0; i < config::register_count; ++i) {
    const auto& r = config::registers[i];
    text += fmt::format("    INT64_C({}), /* {}: {:.9g} {}, {} bits, fraction {} */\n", image[i], r.name,
                        tb::to_value(image[i], r.format), r.unit, r.format.width, r.format.fraction);
  }
  return text + "};\n\n#endif\n";
}

std::string as_memory(const tb::RegisterImage& image) {
  std::string text = fmt::format("// {} words of {} bits, two's complement, in the order of the registers\n",
                                 int{config::register_count}, image_bits);
  for (int i = 0; i < config::register_count; ++i)
    text += fmt::format("{} // {}\n", hex_of(image[i], image_bits), config::registers[i].name);
  return text;
}

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
    recording::write_text(path, as_json(setup, image, model.device));
  else if (extension == ".h")
    recording::write_text(path, as_header(image, model.device));
  else if (extension == ".mem")
    recording::write_text(path, as_memory(image));
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

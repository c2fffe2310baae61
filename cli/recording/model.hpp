// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/recording/json.hpp"

namespace hemi::recording {

inline constexpr const char* kModelFormat = "hemi-model/1";

/// Terms of the bias model, f = frequency - reference_hz [Hz], df its time derivative [Hz/s].
inline constexpr std::array<std::string_view, 10> kBiasTerms = {"1",    "f",    "f^2",  "f^3",    "df",
                                                                "df^2", "df^3", "f*df", "f^2*df", "f*df^2"};

/// Resonator frequency [Hz], ascending polynomial in T - reference_degc.
struct FrequencyModel {
  double reference_degc = 0.0;
  std::vector<double> coefficients_hz{};
};

/// B(f, df) [deg/h].
struct BiasModel {
  double reference_hz = 0.0;
  std::array<double, kBiasTerms.size()> terms_dph{};  ///< order of kBiasTerms
};

/// A command per unit of amplitude [V], ascending polynomial in T - reference_degc.
struct VoltageModel {
  double reference_degc = 0.0;
  std::vector<double> coefficients_v{};
};

/// Parts of a one-sided amplitude spectral density, each as density at 1 Hz.
struct NoiseModel {
  double white = 0.0;
  double flicker = 0.0;
  double random_walk = 0.0;
  double differenced = 0.0;
};

/// y'' + damping y' + stiffness y = gain u + constant_force.
struct BenchModel {
  double gain = 0.0;
  double damping_per_s = 0.0;
  double stiffness_per_s2 = 0.0;
  double constant_force = 0.0;
};

/// One instrument. A part that the file does not hold is absent; unknown keys stay in `document` and are
/// written again.
struct InstrumentModel {
  std::string path{};
  std::string device{};
  std::optional<FrequencyModel> frequency{};
  std::optional<double> thermal_time_constant_s{};
  std::optional<BiasModel> bias{};
  double scale_factor = 1.0;
  std::optional<VoltageModel> drive{};
  std::optional<VoltageModel> quadrature{};
  double amplitude_setpoint = 1.0;
  std::map<std::string, NoiseModel> noise{};  ///< key of the format, such as rate_dph_rthz
  std::optional<BenchModel> bench{};
  Json effects{};  ///< array of corrected models, null where absent
  Json document = Json::object();
};

/// InputError (file, key, problem, remedy) for wrong types, unknown bias terms and impossible values.
InstrumentModel read_model(const std::string& path);

/// The same checks on JSON that is at hand; `path` is for messages.
InstrumentModel model_from_json(const Json& document, const std::string& path);

/// The document with all known parts brought up to date.
Json to_json(const InstrumentModel& model);

/// Whole or not at all; OutputError.
void write_model(const std::string& path, const InstrumentModel& model);

}  // namespace hemi::recording

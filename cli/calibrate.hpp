// SPDX-License-Identifier: Apache-2.0
// What the parts of `hemi calibrate` share.
#ifndef HEMI_CLI_CALIBRATE_HPP
#define HEMI_CLI_CALIBRATE_HPP

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cli/drift_data.hpp"
#include "cli/recording/model.hpp"
#include "cli/recording/recording.hpp"
#include "cli/report/report.hpp"
#include "golden/calibration/frequency_polynomial.hpp"
#include "golden/calibration/settled_fit.hpp"
#include "golden/calibration/thermal_fit.hpp"

namespace hemi::cli {

struct CalibrateOptions {
  std::vector<std::string> inputs;
  std::vector<std::string> heldout;
  std::string base;
  std::string output;
  std::string registers;
  std::string report;
  std::optional<int> order;
  double reference_degc = 0.0;
  std::optional<double> reference_hz;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  std::optional<double> window_s;
  int blocks = 8;
  bool json = false;
};

/// The model as it grows, and what is printed about it.
struct Calibration {
  const CalibrateOptions& options;
  recording::InstrumentModel model{};
  std::string text{};
  recording::Json json{};
  std::vector<report::Plot> plots{};  ///< for the report, where one is asked for

  /// A part that these recordings do not give, and what would: printed, and in the JSON's `left_out`.
  void leave_out(const std::string& part, const std::string& why);
};

/// What the recordings say about the resonator's temperature.
struct ThermalStudy {
  std::vector<recording::Recording> recordings;        ///< those with a case thermometer and a frequency
  std::vector<std::size_t> recording_of;               ///< of each stretch
  std::vector<Eigen::Index> first_row;                 ///< row of its recording that a stretch starts at
  std::vector<calibration::ThermalStretch> stretches;  ///< gap-free
  std::optional<calibration::ThermalFit> fit;
  calibration::Holds holds;
  std::optional<calibration::SettledFit> settled;
};

/// f(T) from a file of settled points.
void calibrate_frequency(const std::string& path, Calibration& calibration);

/// f(T), unless the model has it, and the time constant from chamber recordings; the settled stretches are
/// named. Nothing where no recording has the channels. InputError where they do not suffice.
std::optional<ThermalStudy> calibrate_thermal(const std::vector<recording::Recording>& recordings,
                                              Calibration& calibration);

/// Text and JSON of the settled stretches, used and refused, with the other channels' settled values.
void report_holds(const ThermalStudy& study, Calibration& calibration);

/// Scale factor, drift model, and their scores.
std::optional<DriftData> calibrate_bias(const std::vector<recording::Recording>& recordings,
                                        Calibration& calibration);

/// Drift model and scale factor of `calibration.model` on recordings that the fit has not seen.
void score_heldout(Calibration& calibration);

/// Drive, quadrature, amplitude and noise densities.
void calibrate_channels(const std::vector<recording::Recording>& recordings,
                        const std::optional<ThermalStudy>& thermal, const std::optional<DriftData>& drift,
                        Calibration& calibration);

/// Register values of the core at its own rate (100 kS/s, 200 Hz) for a model.
Setup core_setup(const recording::InstrumentModel& model, std::optional<double> window_s);

/// Writes the register image by extension: .json, .h, .mem; and says what rounding costs.
void write_registers(const std::string& path, Calibration& calibration);

/// f(T) of a model over its calibrated range.
calibration::FrequencyPolynomial frequency_polynomial(const recording::InstrumentModel& model);

/// Rows in runs without a gap over which every channel has a value.
std::vector<calibration::RowRange> complete_rows(const recording::Recording& recording,
                                                 const std::vector<const std::vector<double>*>& channels);

}  // namespace hemi::cli

#endif  // HEMI_CLI_CALIBRATE_HPP

// SPDX-License-Identifier: Apache-2.0
// Raw samples of both pickoffs and the core's records: at which stage of the chain is something left out?
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "golden/diagnosis/stage_core.hpp"
#include "golden/diagnosis/stage_coupling.hpp"
#include "golden/diagnosis/stage_curve.hpp"

namespace hemi::diagnosis {

enum class Stage { none, resonator, pickoff, actuator, adc, demodulation, core };
std::string_view name(Stage stage);

/// A capture from the core's reset on. Samples in LSB, -full_scale_lsb .. full_scale_lsb - 1.
struct StageCapture {
  Eigen::VectorXd x_lsb;
  Eigen::VectorXd y_lsb;
  double sample_rate_hz = 0.0;
  double full_scale_lsb = 0.0;
  RecordedWords recorded;   ///< may be empty: then the core is taken at its word
  CoreRegisters registers;  ///< as the core should hold them
  bool from_reset =
      true;  ///< false: the words of the core cannot be replayed, only the samples are looked at
};

/// Of the nominal instrument: growth of a mode's amplitude (1/s) by a command of 1, and the ADC's fraction of
/// full scale at amplitude 1.
struct StageNominal {
  double full_scale_per_amplitude = 0.8;
  double drive_per_s = 0.0;
  double rebalance_per_s = 0.0;
};

struct StageParameter {
  std::string name;
  double value;
  double sigma;  ///< 0: not estimated
  std::string unit;
};

struct StageFinding {
  Stage stage = Stage::none;
  std::string effect{};  ///< id of the catalogue; "unknown" where it has none
  std::string channel{};
  std::string equation{};
  std::string explanation{};
  double p = 1.0;       ///< of chance, this test alone
  double weight = 0.0;  ///< chi^2 of the finding: the order of the findings
  std::vector<StageParameter> parameters{};
  std::vector<Stage> rivals{};  ///< stages that this capture cannot tell from it
};

/// One test, whether it found something or not.
struct StageTest {
  std::string name;
  double statistic = 0.0;
  double p = 1.0;
  std::string unit;    ///< of the detection limit
  double limit = 0.0;  ///< smallest strength that would have been found (five standard errors); 0: not known
};

struct StageDiagnosis {
  Stage stage = Stage::none;           ///< of the first finding
  std::vector<StageFinding> findings;  ///< heaviest first; a fault of the core before all others
  std::vector<StageTest> tests;
  std::optional<CoreComparison> core;
  CurveChoice curve;  ///< of the primary's harmonics
  ToneFit tones;      ///< primary, of the settled part
  double settled_from_s = 0.0;
  double mean_y_lsb = 0.0, mean_y_sigma_lsb = 0.0;
  std::vector<std::string> notes;  ///< what this capture cannot tell
};

/// Family-wise false alarm of all tests together.
inline constexpr double kStageFalseAlarm = 0.01;

/// Docs: docs/stage.md. Throws std::invalid_argument for a capture shorter than 0.3 s behind its start-up, or
/// without a vibration.
StageDiagnosis diagnose_stage(const StageCapture& capture, const StageNominal& nominal, const Replay& replay);

}  // namespace hemi::diagnosis

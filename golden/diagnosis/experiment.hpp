// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "golden/diagnosis/telemetry.hpp"

namespace hemi::diagnosis {

/// What a user can do to an instrument beside heating and cooling its chamber.
enum class Stimulus { amplitude, rate, attitude, supply, trim, board_heater };
inline constexpr std::array kStimuli = {Stimulus::amplitude, Stimulus::rate, Stimulus::attitude,
                                        Stimulus::supply,    Stimulus::trim, Stimulus::board_heater};

struct Corner {
  double time_s = 0.0, value = 0.0;
};

/// An experiment that could be carried out: a chamber's course, and inputs that are stepped beside it.
struct Experiment {
  std::string program;               ///< of the chamber, in words
  double duration_s = 0.0;           ///< a whole number of minutes
  std::vector<Corner> chamber_degc;  ///< from time 0; straight lines between, the last value held
  std::map<Stimulus, std::vector<Corner>> steps;  ///< each value from its time on; the rest value before

  /// Program and stimuli, a sentence without its full stop.
  std::string in_words() const;
};

/// What an experiment begins with and has to respect, as far as a recording and a model tell.
struct Stand {
  double low_degc = 0.0, high_degc = 0.0, start_degc = 20.0;  ///< of the chamber
  double case_time_constant_s = 600.0;                        ///< behind the chamber
  double board_lag_s = 0.0, board_rise_degc = 8.0;            ///< of the board behind and over the case
  double heater_time_constant_s = 900.0;                      ///< of the board's heater
  double supply_v = 5.0, setpoint = 1.0;
};

/// Range: that of the recorded case, 40 degC at least, and no more than leaves f(T) monotonic and the drive
/// above zero 5 degC beyond it. The board's lag behind the case is the one that leaves least of its recorded
/// temperature.
Stand stand_of(const Telemetry& telemetry, const NominalModel& model);

/// Value that an input rests at, and in words what is stepped by how much.
double rest_value(Stimulus stimulus, const Stand& stand);

/// Chamber programs of up to ten hours: steps and cycles, twice each; cycles at three speeds with minor
/// loops. None stays at one temperature: a run that leaves the model's own polynomials free tells too little
/// of what is not in them.
std::vector<Experiment> chamber_programs(const Stand& stand);

/// The experiment with stimuli added, each with a dwell of its own, so that no two are collinear.
Experiment with_stimuli(Experiment experiment, const std::vector<Stimulus>& stimuli, const Stand& stand);

/// Inputs as an ideal recording would hold them, every `step_s`; no outputs.
Telemetry inputs_of(const Experiment& experiment, const Stand& stand, double step_s);

}  // namespace hemi::diagnosis

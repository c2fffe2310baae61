// SPDX-License-Identifier: Apache-2.0
// The experiment that would separate what a diagnosis cannot, as a scenario that `hemi simulate` runs.
#ifndef HEMI_CLI_SEPARATING_SCENARIO_HPP
#define HEMI_CLI_SEPARATING_SCENARIO_HPP

#include <string>

#include "cli/recording/json.hpp"
#include "cli/recording/model.hpp"
#include "golden/diagnosis/separating_experiment.hpp"

namespace hemi::cli {

inline constexpr const char* kSeparatingScenario = "separating_experiment.toml";
inline constexpr const char* kSeparatingModel = "separating_experiment.model.json";

/// What is done, how long it takes, and the score gap to be expected for each pair: one line.
std::string experiment_sentence(const diagnosis::SeparatingExperiment& found);

/// TOML text; `model`: the instrument model's path relative to the scenario.
std::string scenario_text(const diagnosis::SeparatingExperiment& found, const std::string& model);

/// Searches, writes the scenario and the given model, which it runs with, into `directory`, and names it in
/// `json`: the alternatives' `separating_experiment` and `experiment_in_words`, and an entry of its own. No
/// file where nothing can be separated; nothing at all where there are no alternatives with a trace.
void add_separating_experiment(recording::Json& json, const diagnosis::TelemetryDiagnosis& result,
                               const diagnosis::NominalModel& nominal,
                               const recording::InstrumentModel& given, const std::string& directory,
                               const diagnosis::ExperimentOptions& options = {});

}  // namespace hemi::cli

#endif  // HEMI_CLI_SEPARATING_SCENARIO_HPP

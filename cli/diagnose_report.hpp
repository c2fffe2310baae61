// SPDX-License-Identifier: Apache-2.0
// A diagnosis in words, as diagnosis.json and as a corrected model.
#ifndef HEMI_CLI_DIAGNOSE_REPORT_HPP
#define HEMI_CLI_DIAGNOSE_REPORT_HPP

#include <string>

#include "cli/recording/json.hpp"
#include "cli/recording/model.hpp"
#include "golden/diagnosis/bench_diagnosis.hpp"

namespace hemi::cli {

struct DiagnosedFiles {
  std::string recording;
  std::string model;  ///< empty: the linear model was fitted
  double from_s, to_s;
};

/// Root mean squares before and after, of noise alone, and the gain's interval.
recording::Json before_after(const diagnosis::Gain& gain, double floor_rms);
std::string to_text(const diagnosis::BenchDiagnosis& result);
/// Format hemi-diagnosis/1.
recording::Json to_json(const diagnosis::BenchDiagnosis& result, const DiagnosedFiles& files);
/// `given` with the refitted linear part and what was named as `effects`.
recording::InstrumentModel corrected_model(const diagnosis::BenchDiagnosis& result,
                                           const recording::InstrumentModel& given);
/// The bench part of a model with its effects; InputError for an effect that a bench recording does not have.
diagnosis::BenchPrior prior_of(const recording::InstrumentModel& model);

}  // namespace hemi::cli

#endif  // HEMI_CLI_DIAGNOSE_REPORT_HPP

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "golden/diagnosis/telemetry_diagnosis.hpp"

namespace hemi::diagnosis {

/// An effect in one form with its fitted strength, so that another run can be given it.
struct FittedEffect {
  std::string effect, form;
  std::vector<double> shape;
  std::vector<double> coefficients;
  double deviations = 0.0;  ///< size over its standard error
};

/// Effects of which one, or an unknown one, is at work, beside others that all of them agree on.
struct AlternativeSet {
  std::vector<FittedEffect> alternatives;  ///< the diagnosis's own choice first; each form that fits
  std::vector<FittedEffect> others;
};

/// Every ambiguous effect of a diagnosis with its near rivals, each fitted in its place, shape and strength,
/// in all forms within kNameMargin of its best one.
/// Kinds of noise have no trace and are left out.
std::vector<AlternativeSet> alternative_sets(const TelemetryDiagnosis& diagnosis);

/// The effect as the families of another run write it, its trace in physical units unchanged: radii, widths
/// and centres are shares of a run's range, delays count its samples, clock polynomials start at its mean.
/// Nothing where that run cannot show it.
struct CarriedEffect {
  Member member;
  Eigen::VectorXd coefficients;
};
std::optional<CarriedEffect> carried_over(const FittedEffect& effect, const Simulation& from,
                                          const Simulation& to, const std::vector<EffectFamily>& families);

}  // namespace hemi::diagnosis

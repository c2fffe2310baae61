// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/diagnosis/telemetry_diagnosis.hpp"

namespace hemi::diagnosis {

/// What a search has found, fitted, weighed and sorted into `named` and `ambiguous`, each of these with its
/// doubt; fills in members, fits and improvements as well. `result` has its hypotheses.
void explain(TelemetryDiagnosis& result, const SearchResult& found);

}  // namespace hemi::diagnosis

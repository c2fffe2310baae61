// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "golden/diagnosis/bench_diagnosis.hpp"
#include "golden/diagnosis/colour.hpp"
#include "golden/diagnosis/earned_name.hpp"
#include "golden/diagnosis/effect_search.hpp"
#include "golden/diagnosis/events.hpp"
#include "golden/diagnosis/held_out.hpp"
#include "golden/diagnosis/lines.hpp"
#include "golden/diagnosis/unexplained.hpp"

namespace hemi::diagnosis {

/// Score by which a name has to be ahead of its nearest rival.
inline constexpr double kNameMargin = 6.0;

struct TelemetryOptions {
  Eigen::Index most_rows = 1800;  ///< blocks that every output is averaged to
  std::uint64_t seed = 1;
  std::function<void(double share)> tick = [](double) {};  ///< called between steps; may throw
  std::function<void()> check = [] {};                     ///< called often; may throw
};

/// An effect of the catalogue that explains something, and what competes with it.
struct Explanation {
  std::string effect, form;
  std::vector<Interval> figures;
  double probability = 0.0;
  double worth = 0.0;                                ///< what the score loses without it
  std::string doubt;                                 ///< why it is not named; empty: it is
  std::vector<std::pair<std::string, double>> near;  ///< effects that cost less than the margin more: id, gap
  Trace trace;
  /// Of the form (GivenEffect); of a colour its density at 1 Hz or its step per root second; empty for
  /// events.
  std::vector<double> shape, coefficients;
};

/// A parameter of the model, as given and as this recording has it.
struct Moved {
  std::string name;
  double given = 0.0, refitted = 0.0, deviation = 0.0;
};

struct TelemetryDiagnosis {
  Verdict verdict = Verdict::consistent;
  std::vector<Explanation> named, ambiguous;
  std::vector<Moved> parameters;
  double recalibration_p = 1.0;  ///< Wald test of all parameters together
  std::vector<Improvement> improvement;
  std::vector<Remainder> remainders;
  std::vector<Colour> colours;
  Events events;
  std::vector<Line> lines;
  Isolability isolability;
  Decoys decoys;
  NominalModel corrected;
  Unsettled unsettled;
  std::shared_ptr<const Telemetry> telemetry;  ///< without the rows that events have spoilt
  std::shared_ptr<Hypotheses> hypotheses;      ///< around the corrected model
  HypothesisFit baseline, final;               ///< residuals before and after
  std::vector<Member> members;
};

/// Locates and names what the nominal model leaves out of a recording; docs/diagnosis.md has the method.
/// Throws std::invalid_argument for fewer than 256 rows or no output at all.
TelemetryDiagnosis diagnose_telemetry(const Telemetry& telemetry, const NominalModel& model,
                                      const TelemetryOptions& options = {});

}  // namespace hemi::diagnosis

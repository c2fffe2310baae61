// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "golden/diagnosis/block_statistics.hpp"
#include "golden/diagnosis/simulation_fit.hpp"

namespace hemi::diagnosis {

/// A driven resonator's input and output, equally spaced, without missing values.
struct BenchPart {
  Eigen::VectorXd force_v;
  Eigen::VectorXd displacement_v;
};

/// A model that was given: its terms and all parameters but the first state.
struct BenchPrior {
  std::vector<Term> terms;
  Eigen::VectorXd parameters;  ///< b, d, k1, c, strengths
};

struct BenchOptions {
  std::uint64_t seed = 1;
  std::function<void()> tick = [] {};  ///< called at every simulation; may throw
};

/// What one term did when it was tried beside the model of its step.
struct TermTrial {
  Term term;
  double strength = 0.0;
  double t = 0.0;          ///< max-T statistic, signed
  double p = 1.0;          ///< family-wise
  double overlap = 0.0;    ///< |cosine| of its trace with that of the step's best
  bool simulated = false;  ///< gain from free runs of its own fit; else from the linearised model
  Gain gain;               ///< rows left out
  double score_gap = 0.0;  ///< log of (what the best adds to this one / what this one adds to the best)
  std::string reason;      ///< why it was not taken; empty for the one that was
};

struct BenchStep {
  std::vector<Term> before;
  std::vector<TermTrial> trials;
  std::optional<Term> taken;
  double probability =
      0.0;  ///< of the one taken: share of block resamples in which it beats all that were run
};

struct NamedTerm {
  Term term;
  double strength;
  double half_width95;
  double probability;  ///< BenchStep::probability of its step
};

struct Limit {
  Term term;
  double smallest;  ///< five standard errors
};

enum class Verdict { consistent, recalibrate, named, ambiguous, unknown };
std::string_view name(Verdict verdict);

struct BenchDiagnosis {
  Verdict verdict = Verdict::consistent;
  Hold hold = Hold::band_limited;
  SimulationFit linear;               ///< the baseline with its own parameters refitted
  SimulationFit final;                ///< with what was named
  std::optional<Gain> recalibration;  ///< given model to baseline, rows left out
  double recalibration_p = 1.0;       ///< Wald test of all given parameters together
  std::vector<NamedTerm> named;
  std::vector<std::vector<TermTrial>>
      set_aside;  ///< each: terms that explain one remainder and cannot be told apart
  std::vector<BenchStep> steps;
  Gain train, held_out;            ///< baseline to final: all rows; blocks left out
  double floor_rms = 0.0;          ///< blocks left out, all terms of the library at once
  std::optional<Gain> other_part;  ///< baseline to final on the part that no fit saw
  std::vector<std::pair<std::string, double>> other_part_rivals;  ///< model, rms [V]
  Eigen::Index settling_rows = 0;                                 ///< left out at the start of the other part
  std::size_t decoys = 0, decoys_accepted = 0;
  double white_p = 1.0;  ///< Ljung and Box on the final residual
  double force_p = 1.0;  ///< largest correlation with the force over +-32 samples, corrected
  std::vector<Limit> limits;
};

/// Names what the linear resonator leaves out, as docs/diagnosis.md describes. Throws std::invalid_argument
/// for fewer than 1024 rows, calibration::RankDeficiencyError for a force that does not move, and
/// std::runtime_error where the linear model cannot be fitted.
BenchDiagnosis diagnose_bench(const BenchPart& part, const std::optional<BenchPart>& other,
                              double sample_rate_hz, const std::optional<BenchPrior>& prior,
                              const BenchOptions& options);

}  // namespace hemi::diagnosis

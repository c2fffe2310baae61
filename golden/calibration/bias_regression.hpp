// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "golden/calibration/autoregressive_noise.hpp"
#include "golden/calibration/drift_terms.hpp"
#include "golden/calibration/rows.hpp"

namespace hemi::calibration {

/// What a drift model is fitted to: one row a sample, equally spaced inside each segment.
struct DriftSamples {
  Eigen::VectorXd frequency_hz;    ///< counted frequency, absolute
  Eigen::VectorXd slope_hz_per_s;  ///< its time derivative
  Eigen::VectorXd rate_dph;        ///< rate output less the applied rate
  std::vector<RowRange> segments;  ///< stretches without a gap; rows outside are not used
};

struct StepwiseOptions {
  /// Chance per recording that any term without effect is taken in; inside (0, 1).
  double family_wise_level = 0.05;
  /// Takes the noise for white, as the textbook's partial F-test does.
  bool assume_white_noise = false;
};

/// One term of the final model.
struct SelectedTerm {
  std::size_t term;       ///< index into kDriftTerms
  double coefficient;     ///< [deg/h / (Hz^a (Hz/s)^b)]
  double standard_error;  ///< same unit
  double f_statistic;     ///< partial F of the term in the final model, one numerator degree of freedom
  double dof;             ///< denominator degrees of freedom (Satterthwaite)
  double p_value;
  /// The same test in the model of all ten terms: large where another term could stand in for this one.
  double p_value_against_all;
  /// p_value_against_all is below the level: no combination of the other terms explains the data without this
  /// one. False of a term that the drift needs, but that another one could replace over this excitation.
  bool proven;
};

/// One decision of the procedure, in order.
struct StepwiseAction {
  enum class Kind { kEntered, kRemoved, kExchanged };
  Kind kind;
  std::size_t term;
  std::size_t replaced;  ///< what an exchange took out; `term` itself otherwise
  double f_statistic;
  double dof;
  double p_value;
};

/// Result of the stepwise regression over Eq. (21).
struct BiasRegression {
  double reference_hz = 0.0;
  std::array<double, kDriftTermCount> coefficients{};  ///< of kDriftTerms; zero where not selected
  std::vector<SelectedTerm> terms;                     ///< in order of entry; the constant first
  std::vector<StepwiseAction> log;
  std::vector<std::size_t> undetermined;  ///< terms that these data cannot tell from those before them
  double per_test_level = 0.0;            ///< p-value below which a term enters and above which it leaves
  AutoregressiveNoise noise;              ///< of the averaged rows [deg/h]
  Eigen::Index rows = 0;                  ///< averaged rows that were fitted
  Eigen::Index averaged = 1;              ///< samples averaged into one row
  double effective_samples = 0.0;         ///< independent samples that these rows are worth

  /// B(f, df/dt) [deg/h] at an absolute frequency.
  double predict_dph(double frequency_hz, double slope_hz_per_s) const;
  bool selected(std::size_t term) const;
  /// Table and log as text, one line an entry.
  std::string report() const;
};

/// Stepwise linear regression of the rate over the ten terms of the paper's Eq. (21), by partial F-tests.
///
/// A term enters when it has the smallest p-value of all outside the model and that is below the level; after
/// every entry the term with the largest p-value leaves if that is above the level, and a term inside gives
/// way to one outside as long as that lowers the sum of squares. The constant always stays. The level of a
/// single test is Sidak's, 1 - (1 - family_wise_level)^(1/9), for nine candidates. Coloured noise: an
/// autoregression is fitted by restricted likelihood beside all ten terms, samples and columns are whitened
/// by it, and the F-tests are those of generalised least squares with the residual variance of the full
/// model; their denominator degrees of freedom are Satterthwaite's, 2 v^2 / Var(v) for the variance v of the
/// tested coefficient, so that the uncertainty of the noise model itself is paid for.
/// What the level promises: over recordings, the share in which any term without effect is `proven` is at
/// most family_wise_level whatever the truth is; the share in which any such term is in the model is at most
/// that once the data suffice to hold all true ones. Before that, a drift that is certainly there is carried
/// by the term that fits best, which need not be the true one; it is then not `proven`. Long recordings are
/// averaged to at most 1000 to 2000 rows first: drift is slow, and an autoregression of low order then
/// describes the noise where the drift is, not where it is not. Throws std::invalid_argument: sizes that do
/// not fit, values that are not finite, fewer than 40 rows. Source: the paper's Eq. (19)-(22); Efroymson's
/// stepwise regression; Satterthwaite, Biometrics 2 (1946) 110.
BiasRegression fit_bias(const DriftSamples& samples, double reference_hz,
                        const StepwiseOptions& options = {});

/// All ten terms without selection, by the same generalised least squares; log is empty.
BiasRegression fit_bias_all_terms(const DriftSamples& samples, double reference_hz);

}  // namespace hemi::calibration

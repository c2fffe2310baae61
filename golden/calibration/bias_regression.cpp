// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/bias_regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "golden/calibration/linear_fit.hpp"
#include "golden/calibration/whitened_regression.hpp"

namespace hemi::calibration {
namespace {

constexpr Eigen::Index kLeastRows = 40;
constexpr Eigen::Index kEnoughRows = 1000;

// Regression problem in columns that lie within [-1, 1].
struct Problem {
  std::vector<RowRange> segments;
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
  Eigen::VectorXd scales;  // physical coefficient = coefficient / scale
  Eigen::Index averaged = 1;
};

void check(const DriftSamples& samples, const StepwiseOptions& options) {
  const Eigen::Index size = samples.frequency_hz.size();
  if (samples.slope_hz_per_s.size() != size || samples.rate_dph.size() != size) {
    throw std::invalid_argument("bias regression: frequency, slope and rate differ in length");
  }
  for (const RowRange& range : samples.segments) {
    if (range.begin < 0 || range.count < 0 || range.begin + range.count > size) {
      throw std::invalid_argument("bias regression: a segment reaches outside the samples");
    }
    if (!samples.frequency_hz.segment(range.begin, range.count).allFinite() ||
        !samples.slope_hz_per_s.segment(range.begin, range.count).allFinite() ||
        !samples.rate_dph.segment(range.begin, range.count).allFinite()) {
      throw std::invalid_argument("bias regression: a segment holds values that are not finite");
    }
  }
  if (total_rows(samples.segments) < kLeastRows) {
    throw std::invalid_argument(fmt::format("bias regression: {} rows, at least {} are needed",
                                            total_rows(samples.segments), kLeastRows));
  }
  if (!(options.family_wise_level > 0.0 && options.family_wise_level < 1.0)) {
    throw std::invalid_argument("bias regression: the family-wise level must lie between 0 and 1");
  }
}

// Averages the design's columns, not f and df/dt: the mean of a power is not the power of the mean.
Problem averaged_problem(const DriftSamples& samples, double reference_hz) {
  Problem problem;
  problem.averaged = std::max<Eigen::Index>(1, total_rows(samples.segments) / kEnoughRows);
  Eigen::Index rows = 0;
  for (const RowRange& range : samples.segments) {
    const Eigen::Index blocks = range.count / problem.averaged;
    if (blocks > 0) problem.segments.push_back({rows, blocks});
    rows += blocks;
  }
  problem.x.resize(rows, static_cast<Eigen::Index>(kDriftTermCount));
  problem.y.resize(rows);
  Eigen::Index next = 0;
  for (const RowRange& range : samples.segments) {
    for (Eigen::Index block = 0; block < range.count / problem.averaged; ++block, ++next) {
      const Eigen::Index first = range.begin + block * problem.averaged;
      const Eigen::VectorXd f = samples.frequency_hz.segment(first, problem.averaged).array() - reference_hz;
      problem.x.row(next) =
          drift_design(f, samples.slope_hz_per_s.segment(first, problem.averaged)).colwise().mean();
      problem.y(next) = samples.rate_dph.segment(first, problem.averaged).mean();
    }
  }
  problem.scales = problem.x.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(
      [](double largest) { return largest > 0.0 ? largest : 1.0; });
  problem.x = problem.x * problem.scales.cwiseInverse().asDiagonal();
  return problem;
}

// The procedure itself, over the columns that the data determine; column 0 is the constant.
class Stepwise {
 public:
  Stepwise(const WhitenedRegression& regression, Eigen::Index columns, double level)
      : regression_(regression), columns_(columns), level_(level) {}

  struct Decision {
    StepwiseAction::Kind kind;
    Eigen::Index column;
    Eigen::Index replaced;
    PartialTest test;
  };

  // The procedure ends: a model is never left for one that was there before.
  void run() {
    std::vector<std::vector<Eigen::Index>> seen;
    while (enter()) {
      do {
        while (remove()) {
        }
      } while (exchange());
      std::vector<Eigen::Index> sorted = model_;
      std::sort(sorted.begin(), sorted.end());
      if (std::find(seen.begin(), seen.end(), sorted) != seen.end()) return;
      seen.push_back(std::move(sorted));
    }
  }

  const std::vector<Eigen::Index>& model() const { return model_; }
  const std::vector<Decision>& decisions() const { return decisions_; }

 private:
  bool enter() {
    Decision best{StepwiseAction::Kind::kEntered, -1, -1, {}};
    for (Eigen::Index column = 0; column < columns_; ++column) {
      if (std::find(model_.begin(), model_.end(), column) != model_.end()) continue;
      std::vector<Eigen::Index> candidate = model_;
      candidate.push_back(column);
      const PartialTest test = regression_.test(candidate, candidate.size() - 1);
      if (best.column < 0 || test.p_value < best.test.p_value ||
          (test.p_value == best.test.p_value && test.f_statistic > best.test.f_statistic)) {
        best.column = column;
        best.test = test;
      }
    }
    if (best.column < 0 || !(best.test.p_value < level_)) return false;
    model_.push_back(best.column);
    decisions_.push_back(best);
    return true;
  }

  bool remove() {
    Decision worst{StepwiseAction::Kind::kRemoved, -1, -1, {}};
    std::size_t position = 0;
    for (std::size_t i = 1; i < model_.size(); ++i) {
      const PartialTest test = regression_.test(model_, i);
      if (worst.column < 0 || test.p_value > worst.test.p_value) {
        worst.column = model_[i];
        worst.test = test;
        position = i;
      }
    }
    if (worst.column < 0 || worst.test.p_value < level_) return false;
    model_.erase(model_.begin() + static_cast<std::ptrdiff_t>(position));
    decisions_.push_back(worst);
    return true;
  }

  // Takes the one exchange of a term inside for a term outside that lowers the sum of squares most. Without
  // it a stand-in that entered while a true term was still missing can keep that term out for good.
  bool exchange() {
    double least = regression_.sum_of_squares(model_) * (1.0 - 1e-9);
    std::vector<Eigen::Index> best_model;
    Decision best{StepwiseAction::Kind::kExchanged, -1, -1, {}};
    std::size_t position = 0;
    for (std::size_t i = 1; i < model_.size(); ++i) {
      for (Eigen::Index column = 0; column < columns_; ++column) {
        if (std::find(model_.begin(), model_.end(), column) != model_.end()) continue;
        std::vector<Eigen::Index> candidate = model_;
        candidate[i] = column;
        const double sum = regression_.sum_of_squares(candidate);
        if (sum >= least) continue;
        least = sum;
        best.column = column;
        best.replaced = model_[i];
        position = i;
        best_model = std::move(candidate);
      }
    }
    if (best_model.empty()) return false;
    model_ = std::move(best_model);
    best.test = regression_.test(model_, position);
    decisions_.push_back(best);
    return true;
  }

  const WhitenedRegression& regression_;
  Eigen::Index columns_;
  double level_;
  std::vector<Eigen::Index> model_ = {0};
  std::vector<Decision> decisions_;
};

// Columns that the data determine, as indices of terms.
std::vector<Eigen::Index> determined_columns(const Problem& problem, BiasRegression& result) {
  const std::vector<Eigen::Index> dependent = dependent_columns(problem.x);
  std::vector<Eigen::Index> columns;
  for (Eigen::Index column = 0; column < problem.x.cols(); ++column) {
    if (std::find(dependent.begin(), dependent.end(), column) == dependent.end()) {
      columns.push_back(column);
    } else {
      result.undetermined.push_back(static_cast<std::size_t>(column));
    }
  }
  return columns;
}

BiasRegression fit(const DriftSamples& samples, double reference_hz, const StepwiseOptions& options,
                   bool select) {
  check(samples, options);
  const Problem problem = averaged_problem(samples, reference_hz);
  BiasRegression result;
  result.reference_hz = reference_hz;
  const std::vector<Eigen::Index> columns = determined_columns(problem, result);
  const WhitenedRegression regression(problem.x(Eigen::all, columns), problem.y, problem.segments,
                                      options.assume_white_noise);
  result.noise = regression.noise();
  result.rows = regression.rows();
  result.averaged = problem.averaged;
  result.effective_samples = result.noise.effective_samples(result.rows);
  result.per_test_level =
      -std::expm1(std::log1p(-options.family_wise_level) / static_cast<double>(kDriftTermCount - 1));

  std::vector<Eigen::Index> all(columns.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Eigen::Index>(i);
  Stepwise stepwise(regression, static_cast<Eigen::Index>(columns.size()), result.per_test_level);
  if (select) stepwise.run();
  const std::vector<Eigen::Index>& model = select ? stepwise.model() : all;
  const auto term_of = [&](Eigen::Index column) {
    return static_cast<std::size_t>(columns[static_cast<std::size_t>(column)]);
  };
  for (const Stepwise::Decision& decision : stepwise.decisions()) {
    result.log.push_back({decision.kind, term_of(decision.column),
                          decision.replaced < 0 ? term_of(decision.column) : term_of(decision.replaced),
                          decision.test.f_statistic, decision.test.dof, decision.test.p_value});
  }
  for (std::size_t i = 0; i < model.size(); ++i) {
    const PartialTest test = regression.test(model, i);
    const std::size_t term = term_of(model[i]);
    const double scale = problem.scales(static_cast<Eigen::Index>(term));
    result.coefficients[term] = test.coefficient / scale;
    const double beside_all = regression.test(all, static_cast<std::size_t>(model[i])).p_value;
    result.terms.push_back({term, test.coefficient / scale, test.standard_error / scale, test.f_statistic,
                            test.dof, test.p_value, beside_all, beside_all < result.per_test_level});
  }
  return result;
}

}  // namespace

double BiasRegression::predict_dph(double frequency_hz, double slope_hz_per_s) const {
  double sum = 0.0;
  for (std::size_t term = 0; term < kDriftTermCount; ++term) {
    sum += coefficients[term] * kDriftTerms[term].value(frequency_hz - reference_hz, slope_hz_per_s);
  }
  return sum;
}

bool BiasRegression::selected(std::size_t term) const {
  return std::any_of(terms.begin(), terms.end(), [&](const SelectedTerm& s) { return s.term == term; });
}

std::string BiasRegression::report() const {
  std::string text = fmt::format(
      "{} rows of {} sample(s) each, noise: autoregression of order {}, lag-1 correlation {:.3f}, worth "
      "{:.1f} "
      "independent samples\nlevel of a single test {:.4f}\n",
      rows, averaged, noise.order(), noise.lag1_correlation(), effective_samples, per_test_level);
  for (const StepwiseAction& action : log) {
    const std::string_view verb = action.kind == StepwiseAction::Kind::kRemoved ? "leaves" : "enters";
    const std::string instead = action.kind == StepwiseAction::Kind::kExchanged
                                    ? fmt::format(" in place of {}", kDriftTerms[action.replaced].name)
                                    : std::string();
    text +=
        fmt::format("{} {}{}: F = {:.3g} on 1 and {:.1f} degrees of freedom, p = {:.2g}\n", verb,
                    kDriftTerms[action.term].name, instead, action.f_statistic, action.dof, action.p_value);
  }
  for (const SelectedTerm& term : terms) {
    text += fmt::format("{:<7} {:+.6g} +- {:.2g}  F = {:.3g}  p = {:.2g}{}\n", kDriftTerms[term.term].name,
                        term.coefficient, term.standard_error, term.f_statistic, term.p_value,
                        term.term == 0 || term.proven ? "" : "  (another term could stand in its place)");
  }
  for (const std::size_t term : undetermined) {
    text += fmt::format("{:<7} not determined by these data\n", kDriftTerms[term].name);
  }
  return text;
}

BiasRegression fit_bias(const DriftSamples& samples, double reference_hz, const StepwiseOptions& options) {
  return fit(samples, reference_hz, options, true);
}

BiasRegression fit_bias_all_terms(const DriftSamples& samples, double reference_hz) {
  return fit(samples, reference_hz, {}, false);
}

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/bench_diagnosis.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include "golden/calibration/autoregressive_noise.hpp"
#include "golden/diagnosis/bench_search.hpp"
#include "golden/diagnosis/equation_error.hpp"
#include "golden/diagnosis/series.hpp"

namespace hemi::diagnosis {
namespace {

using calibration::RowRange;
constexpr Eigen::Index kFewestRows = 1024;
constexpr double kSignificance = 0.01;
constexpr Eigen::Index kLags = 32;
constexpr int kDecoysEach = 6;

// Ljung and Box over kLags lags.
double white_p(const Eigen::VectorXd& residual) {
  const Eigen::VectorXd r = residual.array() - residual.mean();
  const auto n = static_cast<double>(r.size());
  double q = 0.0;
  for (Eigen::Index lag = 1; lag <= kLags; ++lag) {
    const double rho = r.head(r.size() - lag).dot(r.tail(r.size() - lag)) / r.squaredNorm();
    q += n * (n + 2.0) * rho * rho / (n - static_cast<double>(lag));
  }
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(static_cast<double>(kLags)), q));
}

// Largest correlation of the whitened residual with the force, both filtered alike, over lags to either side;
// Bonferroni's correction.
double force_p(const Eigen::VectorXd& residual, const Eigen::VectorXd& force) {
  Eigen::MatrixXd both(residual.size(), 2);
  both.col(0) = residual;
  both.col(1) = force.array() - force.mean();
  const Eigen::MatrixXd white = calibration::whiten(both, {{0, residual.size()}}, whitener_of(residual));
  const Eigen::VectorXd e = white.col(0), u = white.col(1);
  double most = 0.0;
  for (Eigen::Index lag = -kLags; lag <= kLags; ++lag) {
    const Eigen::Index rows = e.size() - std::abs(lag);
    const double product =
        e.segment(std::max<Eigen::Index>(lag, 0), rows).dot(u.segment(std::max<Eigen::Index>(-lag, 0), rows));
    most =
        std::max(most, std::abs(product) / (e.norm() * u.norm()) * std::sqrt(static_cast<double>(e.size())));
  }
  const double one = 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), most));
  return std::min(1.0, one * static_cast<double>(2 * kLags + 1));
}

// All given parameters together against those refitted.
double wald_p(const SimulationFit& fit, const BenchPrior& prior) {
  const Eigen::Index free = fit.form.start_row();
  const Eigen::VectorXd difference = fit.parameters.head(free) - prior.parameters;
  const Eigen::MatrixXd covariance = fit.covariance.topLeftCorner(free, free);
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::VectorXd z = scale.cwiseProduct(difference);
  const double distance = z.dot(correlation.ldlt().solve(z));
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(static_cast<double>(free)), std::max(0.0, distance)));
}

SimulationFit linear_fit(const BenchSearch& search, const Eigen::Vector4d& start,
                         const std::optional<BenchPrior>& prior) {
  const std::vector<Term> terms = prior ? prior->terms : std::vector<Term>{};
  const BenchForm form{terms};
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(form.size());
  parameters.head(kLinear) = start;
  if (prior) parameters.head(form.start_row()) = prior->parameters;
  parameters[form.start_row()] = search.part().displacement_v[0];
  return search.fit_from(terms, parameters);
}

// The hold under which a model leaves least; noise and the model's other errors are the same for all three.
Hold best_hold(const BenchPart& part, double rate_hz, const BenchOptions& options, const SimulationFit& model,
               double* least = nullptr) {
  Hold best = Hold::band_limited;
  double smallest = INFINITY;
  for (const Hold hold : {Hold::band_limited, Hold::zero_order, Hold::linear}) {
    const BenchSearch search(part, rate_hz, options, hold, model.parameters[kStiffness]);
    const double left = search.fit(model.form.terms, model).rms();
    if (left < smallest) {
      smallest = left;
      best = hold;
    }
  }
  if (least != nullptr) *least = smallest;
  return best;
}

void score_other_part(BenchDiagnosis& result, const BenchPart& other, double rate_hz,
                      const BenchSearch& search) {
  const BenchInput input(other.force_v, rate_hz, search.input().substeps(), result.hold);
  // Free decay to e^-14, a millionth, of a wrong first state.
  const double decay_s = 28.0 / std::max(result.final.parameters[kDamping], 1e-9);
  result.settling_rows = static_cast<Eigen::Index>(
      std::min(std::ceil(decay_s * rate_hz), 0.5 * static_cast<double>(input.rows())));
  const Eigen::Index rows = input.rows() - result.settling_rows;
  const auto left_by = [&](const SimulationFit& fit) -> Eigen::VectorXd {
    Eigen::VectorXd parameters = fit.parameters;
    parameters.tail(2).setZero();
    return (other.displacement_v - simulate(input, fit.form, parameters)).tail(rows);
  };
  result.other_part = bootstrap_gain(left_by(result.linear), left_by(result.final), equal_blocks(rows, 40),
                                     search.options().seed);
  std::vector<std::vector<Term>> forms;
  for (const TermInfo& each : bench_terms()) {
    if (result.named.empty()) break;
    forms.push_back(result.linear.form.terms);
    forms.back().push_back(each.term);
  }
  for (const TermInfo& each : bench_terms()) {
    if (place_of(result.final.form, each.term) >= 0) continue;
    forms.push_back(result.final.form.terms);
    forms.back().push_back(each.term);
  }
  for (const auto& terms : forms) {
    std::string label;
    for (const Term term : terms) label += (label.empty() ? "" : " + ") + std::string(info(term).shape);
    const bool beside_final = terms.size() == result.final.form.terms.size() + 1 && !result.named.empty();
    result.other_part_rivals.emplace_back(
        label, rms(left_by(search.fit(terms, beside_final ? result.final : result.linear))));
  }
}

// Adds terms while one is earned; groups that cannot be told apart are set aside.
SimulationFit add_terms(BenchSearch& search, SimulationFit model, BenchDiagnosis& result) {
  std::vector<Term> aside;
  while (model.form.terms.size() < kTerms) {
    result.steps.push_back(search.step(model, aside));
    const BenchStep& step = result.steps.back();
    if (step.taken) {
      std::vector<Term> terms = step.before;
      terms.push_back(*step.taken);
      model = search.fit(terms, model);
      result.named.push_back({*step.taken, 0.0, 0.0, step.probability});
      continue;
    }
    std::vector<TermTrial> group;
    for (const TermTrial& trial : step.trials) {
      const bool best = trial.overlap == 1.0;
      if (best || trial.reason == "not separable from the best" ||
          trial.reason == "another form of the same effect")
        group.push_back(trial);
    }
    if (group.empty()) break;
    // Those beaten go with it: they would only stand in for what is not named.
    for (const TermTrial& trial : step.trials) {
      if (trial.overlap >= kRivalOverlap) aside.push_back(trial.term);
    }
    // Beside a force that has no name, the next best term is a stand-in for it.
    const bool nameless = std::ranges::any_of(group, [](const TermTrial& trial) {
      return trial.overlap == 1.0 && info(trial.term).effect.empty();
    });
    result.set_aside.push_back(std::move(group));
    if (nameless) break;
  }
  return model;
}

// Takes out what the terms that came later have made superfluous.
SimulationFit take_out(const BenchSearch& search, SimulationFit model, BenchDiagnosis& result) {
  for (std::size_t i = 0; i < result.named.size() && result.named.size() > 1;) {
    std::vector<Term> terms = model.form.terms;
    std::erase(terms, result.named[i].term);
    const SimulationFit without = search.fit(terms, model);
    const Gain gain = bootstrap_gain(search.held_out(without), search.held_out(model), search.blocks(),
                                     search.options().seed);
    if (gain.low > 0.0) {
      ++i;
      continue;
    }
    model = without;
    result.named.erase(result.named.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return model;
}

Verdict verdict_of(const BenchDiagnosis& result) {
  if (!result.named.empty()) return Verdict::named;
  for (const auto& group : result.set_aside) {
    const bool in_catalogue = std::ranges::any_of(group, [](const TermTrial& trial) {
      return !info(trial.term).effect.empty() && trial.reason != "unphysical sign";
    });
    if (in_catalogue && group.size() > 1) return Verdict::ambiguous;
  }
  if (!result.set_aside.empty()) return Verdict::unknown;
  const bool moved =
      result.recalibration && result.recalibration->low > 0.0 && result.recalibration_p < kSignificance;
  return moved ? Verdict::recalibrate : Verdict::consistent;
}

}  // namespace

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::consistent:
      return "consistent";
    case Verdict::recalibrate:
      return "recalibrate";
    case Verdict::named:
      return "named";
    case Verdict::ambiguous:
      return "ambiguous";
    case Verdict::unknown:
      return "unknown";
  }
  return "";
}

BenchDiagnosis diagnose_bench(const BenchPart& part, const std::optional<BenchPart>& other,
                              double sample_rate_hz, const std::optional<BenchPrior>& prior,
                              const BenchOptions& options) {
  if (part.force_v.size() < kFewestRows) throw std::invalid_argument("fewer than 1024 rows");
  const Eigen::Vector4d start = equation_error_start(part.force_v, part.displacement_v, sample_rate_hz);
  if (!(start[kStiffness] > 0.0)) throw std::runtime_error("no resonance is seen in the displacement");
  BenchDiagnosis result;
  auto search = std::make_unique<BenchSearch>(part, sample_rate_hz, options, result.hold, start[kStiffness]);
  SimulationFit model = linear_fit(*search, start, prior);
  if (!model.converged)
    throw std::runtime_error("the simulation of the linear model does not settle on parameters");
  result.hold = best_hold(part, sample_rate_hz, options, model);
  search =
      std::make_unique<BenchSearch>(part, sample_rate_hz, options, result.hold, model.parameters[kStiffness]);
  result.linear = search->fit(model.form.terms, model);
  if (prior) {
    Eigen::VectorXd given = result.linear.parameters;
    given.head(prior->parameters.size()) = prior->parameters;
    const Eigen::VectorXd before = part.displacement_v - simulate(search->input(), result.linear.form, given);
    result.recalibration =
        bootstrap_gain(before, search->held_out(result.linear), search->blocks(), options.seed);
    result.recalibration_p = wald_p(result.linear, *prior);
  }
  result.final = take_out(*search, add_terms(*search, result.linear, result), result);
  for (NamedTerm& named : result.named) {
    const Eigen::Index place = place_of(result.final.form, named.term);
    named.strength = result.final.parameters[place];
    named.half_width95 = result.final.half_width95(place, static_cast<Eigen::Index>(search->blocks().size()));
  }
  result.train =
      bootstrap_gain(result.linear.residual, result.final.residual, search->blocks(), options.seed);
  result.held_out = bootstrap_gain(search->held_out(result.linear), search->held_out(result.final),
                                   search->blocks(), options.seed);
  result.floor_rms = search->floor_rms(result.final);
  std::tie(result.decoys, result.decoys_accepted) = search->decoys(result.final, kDecoysEach);
  result.limits = search->limits(result.final);
  result.white_p = white_p(result.final.residual);
  result.force_p = force_p(result.final.residual, part.force_v);
  result.verdict = verdict_of(result);
  if (other) score_other_part(result, *other, sample_rate_hz, *search);
  return result;
}

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/bench_search.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace hemi::diagnosis {
namespace {

using calibration::RowRange;
constexpr Eigen::Index kBlocks = 40;
constexpr Eigen::Index kFolds = 8;
// The best must add this many times more to a rival than the rival adds to it.
constexpr double kMargin = 10.0;
// Terms whose gain is at least this share of the best one's linearised gain are fitted and run freely.
constexpr double kWorthRunning = 0.5;

double mean_square(const Eigen::VectorXd& r) {
  return r.squaredNorm() / static_cast<double>(r.size());
}

bool sign_is_physical(Term term, double strength) {
  return info(term).effect != "damping_nonlinearity" || strength > 0.0;
}

}  // namespace

Eigen::Index place_of(const BenchForm& form, Term term) {
  const auto found = std::ranges::find(form.terms, term);
  return found == form.terms.end() ? -1 : kLinear + (found - form.terms.begin());
}

BenchSearch::BenchSearch(const BenchPart& part, double sample_rate_hz, const BenchOptions& options, Hold hold,
                         double stiffness_per_s2)
    : part_(part),
      options_(options),
      input_(part.force_v, sample_rate_hz, substeps_for(stiffness_per_s2, sample_rate_hz), hold),
      blocks_(equal_blocks(part.force_v.size(), kBlocks)),
      folds_(equal_blocks(part.force_v.size(), kFolds)) {}

SimulationFit BenchSearch::fit_from(const std::vector<Term>& terms, const Eigen::VectorXd& start) const {
  return fit_simulation(input_, part_.displacement_v, {terms}, start, blocks_, options_.tick);
}

SimulationFit BenchSearch::fit(const std::vector<Term>& terms, const SimulationFit& from) const {
  const BenchForm form{terms};
  Eigen::VectorXd start = Eigen::VectorXd::Zero(form.size());
  start.head(kLinear) = from.parameters.head(kLinear);
  start.tail(2) = from.parameters.tail(2);
  for (const Term term : terms) {
    const Eigen::Index before = place_of(from.form, term);
    if (before >= 0) start[place_of(form, term)] = from.parameters[before];
  }
  return fit_from(terms, start);
}

Eigen::VectorXd BenchSearch::held_out(const SimulationFit& fit) const {
  return held_out_residual(input_, part_.displacement_v, fit, folds_, options_.tick);
}

BenchSearch::Probe BenchSearch::probe(const SimulationFit& model) const {
  Probe probe{.all = {.form = model.form, .parameters = {}, .covariance = {}, .residual = {}, .jacobian = {}},
              .absent = {},
              .model = model.jacobian,
              .columns = {}};
  for (const TermInfo& each : bench_terms()) {
    if (place_of(model.form, each.term) < 0) probe.absent.push_back(each.term);
  }
  BenchForm& form = probe.all.form;
  form.terms.insert(form.terms.end(), probe.absent.begin(), probe.absent.end());
  probe.all.parameters = Eigen::VectorXd::Zero(form.size());
  probe.all.parameters.head(model.form.start_row()) = model.parameters.head(model.form.start_row());
  probe.all.parameters.tail(2) = model.parameters.tail(2);
  probe.all.residual =
      part_.displacement_v - simulate(input_, form, probe.all.parameters, probe.all.jacobian);
  options_.tick();
  probe.columns =
      probe.all.jacobian.middleCols(model.form.start_row(), static_cast<Eigen::Index>(probe.absent.size()));
  return probe;
}

// The fold's rows predicted by the linearised model fitted to the others.
Eigen::VectorXd BenchSearch::linear_held_out(const Probe& probe,
                                             const std::vector<Eigen::Index>& with) const {
  // The first state, which only the first rows see, is kept.
  const Eigen::Index own_columns = probe.model.cols() - 2;
  Eigen::MatrixXd x(probe.model.rows(), own_columns + static_cast<Eigen::Index>(with.size()));
  x.leftCols(own_columns) = probe.model.leftCols(own_columns);
  for (std::size_t i = 0; i < with.size(); ++i)
    x.col(own_columns + static_cast<Eigen::Index>(i)) = probe.columns.col(with[i]);
  const Eigen::VectorXd scale = x.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  x = x * scale.asDiagonal();
  const Eigen::VectorXd& r = probe.all.residual;
  const Eigen::MatrixXd gram = x.transpose() * x;
  const Eigen::VectorXd right = x.transpose() * r;
  Eigen::VectorXd result(r.size());
  for (const RowRange& fold : folds_) {
    const auto own = x.middleRows(fold.begin, fold.count);
    const auto own_r = r.segment(fold.begin, fold.count);
    Eigen::MatrixXd rest = gram - own.transpose() * own;
    rest.diagonal().array() += 1e-12;
    const Eigen::VectorXd b = rest.ldlt().solve(right - own.transpose() * own_r);
    result.segment(fold.begin, fold.count) = own_r - own * b;
  }
  return result;
}

BenchStep BenchSearch::step(const SimulationFit& model, const std::vector<Term>& aside) const {
  const Probe probed = probe(model);
  const MaxT test = max_t(model.residual, model.jacobian, probed.columns, 0, whitener_of(model.residual),
                          kBlocks, options_.seed);
  BenchStep step{.before = model.form.terms, .trials = {}, .taken = std::nullopt};
  const Eigen::VectorXd before = linear_held_out(probed, {});
  for (std::size_t i = 0; i < probed.absent.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    TermTrial trial{.term = probed.absent[i], .gain = {}, .reason = {}};
    trial.t = test.statistic[column];
    trial.p = test.p[column];
    trial.gain = bootstrap_gain(before, linear_held_out(probed, {column}), blocks_, options_.seed);
    if (std::ranges::find(aside, trial.term) != aside.end()) trial.reason = "set aside";
    step.trials.push_back(trial);
  }
  judge(step, model, test);
  return step;
}

void BenchSearch::judge(BenchStep& step, const SimulationFit& model, const MaxT& test) const {
  const Eigen::VectorXd before = held_out(model);
  double most = 0.0;
  for (const TermTrial& trial : step.trials) {
    if (trial.reason.empty() && trial.p <= kFamilyWise) most = std::max(most, trial.gain.gain());
  }
  std::vector<SimulationFit> fits(step.trials.size());
  std::vector<Eigen::VectorXd> residuals(step.trials.size());
  const auto run_freely = [&](std::size_t i) {
    TermTrial& trial = step.trials[i];
    if (trial.simulated) return;
    std::vector<Term> terms = step.before;
    terms.push_back(trial.term);
    fits[i] = fit(terms, model);
    residuals[i] = held_out(fits[i]);
    trial.simulated = true;
    trial.strength = fits[i].parameters[place_of(fits[i].form, trial.term)];
    trial.gain = bootstrap_gain(before, residuals[i], blocks_, options_.seed);
  };
  std::size_t best = step.trials.size();
  for (std::size_t i = 0; i < step.trials.size(); ++i) {
    TermTrial& trial = step.trials[i];
    if (!trial.reason.empty()) continue;
    if (trial.p > kFamilyWise) {
      trial.reason = fmt::format("not significant (family-wise p {:.2g})", trial.p);
      continue;
    }
    if (trial.gain.gain() < kWorthRunning * most) {
      trial.reason = "another term gains more than twice as much";
      continue;
    }
    run_freely(i);
    if (!(trial.gain.low > 0.0)) {
      trial.reason = "no gain in free run on rows left out";
      continue;
    }
    if (best == step.trials.size() || trial.gain.after_rms < step.trials[best].gain.after_rms) best = i;
  }
  if (best == step.trials.size()) return;

  // Rivals: what the best adds to each of them against what each adds to the best.
  TermTrial& first = step.trials[best];
  const Probe beside = probe(fits[best]);
  const double alone = mean_square(residuals[best]);
  for (std::size_t i = 0; i < step.trials.size(); ++i) {
    TermTrial& trial = step.trials[i];
    trial.overlap = std::abs(test.overlap(static_cast<Eigen::Index>(best), static_cast<Eigen::Index>(i)));
    if (i == best || trial.reason == "set aside" || trial.overlap < kRivalOverlap) continue;
    run_freely(i);
    const auto found = std::ranges::find(beside.absent, trial.term);
    const double both = mean_square(linear_held_out(beside, {found - beside.absent.begin()}));
    const double adds_to_best = std::max(alone - both, 1e-6 * alone);
    const double best_adds = mean_square(residuals[i]) - std::min(both, alone);
    trial.score_gap = std::log(std::max(best_adds, 1e-9 * alone) / adds_to_best);
    const Gain margin = bootstrap_gain(residuals[i], residuals[best], blocks_, options_.seed);
    const bool beaten = margin.low > 0.0 && trial.score_gap >= std::log(kMargin);
    const bool same_effect =
        !info(trial.term).effect.empty() && info(trial.term).effect == info(first.term).effect;
    trial.reason = beaten        ? "beaten out of sample"
                   : same_effect ? "another form of the same effect"
                                 : "not separable from the best";
  }
  if (!sign_is_physical(first.term, first.strength))
    first.reason = "unphysical sign";
  else if (!parts_agree(fits[best], first.term))
    first.reason = "parts of the recording disagree";
  else if (std::ranges::any_of(step.trials,
                               [](const auto& t) { return t.reason == "not separable from the best"; }))
    first.reason = "rivals explain as much";
  else if (info(first.term).effect.empty())
    first.reason = "no effect of the catalogue";
  else
    step.taken = first.term;
  std::vector<Eigen::VectorXd> others = {before};
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    // A separate effect is no rival: its turn comes.
    if (i != best && step.trials[i].simulated && step.trials[i].overlap >= kRivalOverlap)
      others.push_back(residuals[i]);
  }
  step.probability = share_won(residuals[best], others, blocks_, options_.seed);
  if (!step.taken) first.overlap = 1.0;
}

bool BenchSearch::parts_agree(const SimulationFit& fit, Term term) const {
  const Eigen::Index place = place_of(fit.form, term);
  const auto quarters = equal_blocks(fit.residual.size(), 4);
  Eigen::Vector4d values;
  for (Eigen::Index q = 0; q < 4; ++q)
    values[q] = parameters_from(fit, {quarters[static_cast<std::size_t>(q)]})[place];
  const double mean = values.mean();
  const double scatter = std::sqrt((values.array() - mean).square().sum() / 3.0);
  // A quarter knows the strength half as well as the whole; three of its standard errors are chance.
  const double expected = 3.0 * 2.0 * std::sqrt(fit.covariance(place, place));
  return (values.array() * mean > 0.0).all() && scatter <= std::max(0.25 * std::abs(mean), expected);
}

double BenchSearch::floor_rms(const SimulationFit& model) const {
  const Probe probed = probe(model);
  std::vector<Eigen::Index> all(probed.absent.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Eigen::Index>(i);
  return std::sqrt(
      std::min(mean_square(linear_held_out(probed, all)), mean_square(linear_held_out(probed, {}))));
}

std::pair<std::size_t, std::size_t> BenchSearch::decoys(const SimulationFit& model, int each) const {
  const Probe probed = probe(model);
  const Eigen::Index real = probed.columns.cols();
  Eigen::MatrixXd columns(probed.columns.rows(), real * (1 + each));
  columns.leftCols(real) = probed.columns;
  for (Eigen::Index j = 0; j < real * each; ++j)
    columns.col(real + j) = decoy_of(probed.columns.col(j % real), (j / real) % 2 == 1,
                                     options_.seed + static_cast<std::uint64_t>(j));
  const MaxT test = max_t(model.residual, model.jacobian, columns, real * each, whitener_of(model.residual),
                          kBlocks, options_.seed);
  const auto made = static_cast<std::size_t>(real * each);
  const auto accepted = (test.statistic.tail(real * each).array().abs() > test.critical).count();
  return {made, static_cast<std::size_t>(accepted)};
}

std::vector<Limit> BenchSearch::limits(const SimulationFit& model) const {
  const Probe probed = probe(model);
  const MaxT test = max_t(model.residual, model.jacobian, probed.columns, 0, whitener_of(model.residual),
                          kBlocks, options_.seed);
  std::vector<Limit> limits;
  for (std::size_t i = 0; i < probed.absent.size(); ++i) {
    if (!info(probed.absent[i]).effect.empty())
      limits.push_back({probed.absent[i], 5.0 / test.norm[static_cast<Eigen::Index>(i)]});
  }
  return limits;
}

}  // namespace hemi::diagnosis

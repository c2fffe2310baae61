// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/telemetry_diagnosis.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "golden/diagnosis/explain.hpp"
#include "golden/diagnosis/what_remains.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Members = std::vector<Member>;

// In units of the score, twice a log likelihood.
constexpr double kStructureInTime = 150.0;
constexpr Index kFineNodes = 32;
constexpr double kRecalibrate_p = 1e-6;
constexpr double kRecalibrateTogether_p = 1e-12;
constexpr double kMovedAlone = 4.5;
constexpr double kRemaining = 0.35;  // of the squares beyond noise
constexpr std::size_t kLeastRepeats = 3;
constexpr int kRounds = 3;

struct Around {
  std::shared_ptr<Hypotheses> hypotheses;
  SearchResult found;
  NominalModel model;
  Unsettled unsettled;
};

class Diagnosis {
 public:
  Diagnosis(const Telemetry& telemetry, const NominalModel& model, const TelemetryOptions& options)
      : events_(find_events(telemetry, simulate(telemetry, model))),
        cleaned_(std::make_shared<const Telemetry>(without_events(telemetry, events_))),
        telemetry_(*cleaned_),
        given_(model),
        options_(options),
        space_(telemetry_, options.most_rows) {}

  TelemetryDiagnosis run();

 private:
  std::shared_ptr<Hypotheses> around(const NominalModel& model, const Unsettled& unsettled, bool effects) {
    Simulation s = simulate(telemetry_, model, unsettled);
    auto families = effects ? effect_families(s) : std::vector<EffectFamily>{};
    auto h = std::make_shared<Hypotheses>(telemetry_, space_, std::move(s), std::move(families));
    h->check_with(options_.check);
    return h;
  }
  void relinearise(NominalModel& model, Unsettled& unsettled, const Members& members, int times);
  Around search_from(NominalModel model, Unsettled unsettled);
  void compare_parameters(TelemetryDiagnosis& result);
  void name_events(TelemetryDiagnosis& result);
  void decide(TelemetryDiagnosis& result);

  Events events_;
  std::shared_ptr<const Telemetry> cleaned_;
  const Telemetry& telemetry_;
  const NominalModel& given_;
  const TelemetryOptions& options_;
  RowSpace space_;
};

// Steps of Gauss and Newton; one that makes things worse is taken back: where a run hardly tells the
// parameters apart, the linear step may lead anywhere.
void Diagnosis::relinearise(NominalModel& model, Unsettled& unsettled, const Members& members, int times) {
  NominalModel model_before = model;
  Unsettled unsettled_before = unsettled;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= times; ++i) {
    const auto h = around(model, unsettled, !members.empty());
    const auto fit = members.empty() ? h->fit(members, h->expected()) : h->fit(members);
    if (fit.minus_two_log_likelihood > before + 1.0) {
      model = model_before;
      unsettled = unsettled_before;
      return;
    }
    if (i == times) return;
    before = fit.minus_two_log_likelihood;
    model_before = model;
    unsettled_before = unsettled;
    move_parameters(h->baseline(), fit.coefficients.head(static_cast<Index>(h->baseline().size())), model,
                    unsettled);
  }
}

Around Diagnosis::search_from(NominalModel model, Unsettled unsettled) {
  Around result{nullptr, {}, std::move(model), std::move(unsettled)};
  for (int round = 0; round < kRounds; ++round) {
    result.hypotheses = around(result.model, result.unsettled, true);
    result.found = EffectSearch(*result.hypotheses).run();
    const double tau = result.model.time_constant_s;
    if (round + 1 == kRounds || result.found.best.members.empty()) break;
    relinearise(result.model, result.unsettled, result.found.best.members, 2);
    // Half a percent of tau: the second order of the step is 1e-5 of the transient.
    if (std::abs(std::log(result.model.time_constant_s / tau)) < 0.005) break;
  }
  return result;
}

std::vector<double> values_of(const std::vector<BaselineColumn>& columns, const NominalModel& model) {
  // A unit step from a model of zeros would do as well; asking the model by name keeps one list of names.
  std::vector<double> values;
  for (const auto& column : columns) values.push_back(parameter(model, column.name));
  return values;
}

void Diagnosis::compare_parameters(TelemetryDiagnosis& result) {
  const auto& h = *result.hypotheses;
  const auto given = values_of(h.baseline(), given_);
  auto now = values_of(h.baseline(), result.corrected);
  std::vector<Index> kept;
  VectorXd moved(static_cast<Index>(given.size()));
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto k = static_cast<Index>(i);
    const bool ratio = h.baseline()[i].name == "thermal.time_constant_s";
    const double step = result.final.coefficients[k];
    moved[k] = (ratio ? std::log(now[i] / given[i]) : now[i] - given[i]) + step;
    if (h.baseline()[i].nuisance) continue;
    kept.push_back(k);
    const double deviation = std::sqrt(result.final.covariance(k, k));
    result.parameters.push_back({h.baseline()[i].name, given[i],
                                 ratio ? now[i] * std::exp(step) : now[i] + step,
                                 ratio ? now[i] * deviation : deviation});
  }
  if (kept.empty()) return;
  const MatrixXd covariance = result.final.covariance(kept, kept);
  const VectorXd scale = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const VectorXd z = scale.asDiagonal() * VectorXd(moved(kept));
  MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  correlation.diagonal().array() += 1e-9;
  const double square = z.dot(correlation.ldlt().solve(z));
  result.recalibration_p = boost::math::cdf(boost::math::complement(
      boost::math::chi_squared(static_cast<double>(kept.size())), std::max(square, 0.0)));
}

// Explanation that single rows or a line give; its own test has been passed already.
Explanation certain(const char* effect, const char* form, double worth) {
  Explanation entry;
  entry.effect = effect;
  entry.form = form;
  entry.worth = worth;
  entry.probability = 0.99;
  return entry;
}

void Diagnosis::name_events(TelemetryDiagnosis& result) {
  result.events = events_;
  const auto count = [&](const char* effect, const char* form, std::size_t rows, std::size_t least) {
    if (rows < least) return;
    Explanation entry = certain(effect, form, 20.0 * static_cast<double>(rows));
    const auto value = static_cast<double>(rows);
    entry.figures = {{{"count", "1", value}, value, value}};
    result.named.push_back(std::move(entry));
  };
  count("sample_loss", "rows that repeat the one before", events_.repeats.size(), kLeastRepeats);
  count("cycle_slip", "pulses of whole turns in the frequency", events_.slips.size(), 1);
  const Simulation& s = result.hypotheses->simulation();
  for (const Output output : {Output::frequency, Output::rate}) {
    if (!telemetry_.has(output)) continue;
    VectorXd residual = telemetry_[output] - s.nominal[output];
    for (std::size_t i = 0; i < result.hypotheses->baseline().size(); ++i) {
      const auto& column = result.hypotheses->baseline()[i].trace[output];
      if (column.size() > 0) residual -= result.final.coefficients[static_cast<Index>(i)] * column;
    }
    for (const auto* group : {&result.named, &result.ambiguous})
      for (const auto& entry : *group)
        if (entry.trace[output].size() > 0) residual -= entry.trace[output];
    for (const auto& remainder : result.remainders)
      if (remainder.output == output) residual -= along_rows(s, remainder);
    const auto line = find_line(telemetry_, s, output, residual);
    if (!line) continue;
    result.lines.push_back(*line);
    Explanation entry =
        line->harmonic == 0
            ? certain("interference", "sinusoid that stands still", -2.0 * line->log_p)
            : certain("aliased_carrier", "sinusoid that moves with the resonator", -2.0 * line->log_p);
    const double half = 1.96 * line->amplitude_deviation;
    entry.figures = {{{"amplitude", std::string(kOutputUnits[place(output)]), line->amplitude},
                      line->amplitude - half,
                      line->amplitude + half},
                     {{"frequency", "Hz", line->frequency_hz},
                      line->frequency_hz - 1.96 * line->frequency_deviation_hz,
                      line->frequency_hz + 1.96 * line->frequency_deviation_hz}};
    result.named.push_back(std::move(entry));
  }
}

// All parameters together have moved, and either one of them by itself or all by far: the equations'
// discretisation alone moves well-known combinations by parts of a deviation each.
bool recalibrated(const TelemetryDiagnosis& result) {
  const bool one = std::ranges::any_of(result.parameters, [](const Moved& each) {
    return std::abs(each.refitted - each.given) > kMovedAlone * each.deviation;
  });
  return result.recalibration_p < (one ? kRecalibrate_p : kRecalibrateTogether_p);
}

void Diagnosis::decide(TelemetryDiagnosis& result) {
  const auto structured = [&](Output output) {
    return std::ranges::any_of(result.remainders, [&](const Remainder& r) {
      // A function of time alone is what coloured noise looks like as well; with that many nodes it is not: a
      // walk's few slowest ones hold most of it.
      const bool enough =
          r.variable != "time_s" || r.evidence > kStructureInTime || r.at.size() >= kFineNodes;
      return r.output == output && enough && (result.members.empty() || r.share > kRemaining);
    });
  };
  // A name that leaves most of the misfit where it was is no explanation.
  for (auto entry = result.named.begin(); entry != result.named.end();) {
    const bool poor = std::ranges::any_of(
        kOutputs, [&](Output output) { return entry->trace[output].size() > 0 && structured(output); });
    if (!poor) {
      ++entry;
      continue;
    }
    entry->doubt = "most of the misfit is left by it";
    result.ambiguous.push_back(std::move(*entry));
    entry = result.named.erase(entry);
  }
  const bool unknown = std::ranges::any_of(kOutputs, structured);
  for (const auto& colour : result.colours) {
    if (unknown) continue;
    Explanation entry;
    entry.worth = colour.evidence;
    const bool walk = colour.walk_over_flicker > 0.0;
    entry.effect = walk ? "rate_random_walk" : "rate_flicker";
    entry.form = walk ? "random walk beyond what the model states" : "1/f noise beyond what the model states";
    entry.probability = 1.0 / (1.0 + std::exp(-0.5 * std::abs(colour.walk_over_flicker)));
    const double value = walk ? colour.walk : colour.flicker;
    const double factor = std::exp(1.96 * colour.log_deviation);
    entry.coefficients = {walk ? colour.walk : colour.flicker_rthz};
    entry.figures = {{{"density", walk ? "deg/h/sqrt(s)" : "deg/h", value}, value / factor, value * factor}};
    if (std::abs(colour.walk_over_flicker) < kNameMargin) {
      entry.near.emplace_back(walk ? "rate_flicker" : "rate_random_walk", std::abs(colour.walk_over_flicker));
      entry.doubt = "the recording is too short to tell the slope of the noise";
    }
    (entry.doubt.empty() ? result.named : result.ambiguous).push_back(std::move(entry));
  }
  const bool several =
      std::ranges::any_of(result.ambiguous, [](const Explanation& e) { return !e.near.empty(); });
  if (several && !unknown)
    result.verdict = Verdict::ambiguous;
  else if (!result.named.empty())
    result.verdict = Verdict::named;
  else if (unknown)
    result.verdict = Verdict::unknown;
  else if (recalibrated(result))
    result.verdict = Verdict::recalibrate;
}

TelemetryDiagnosis Diagnosis::run() {
  NominalModel refitted = given_;
  Unsettled start;
  relinearise(refitted, start, {}, 3);
  options_.tick(0.1);
  Around best = search_from(refitted, start);
  options_.tick(0.5);
  // Where a strong effect pulled the baseline away, the model as given is the better place to begin.
  if (std::abs(std::log(refitted.time_constant_s / given_.time_constant_s)) > 0.003) {
    Around other = search_from(given_, {});
    if (other.found.best.score < best.found.best.score) best = std::move(other);
  }
  options_.tick(0.7);
  TelemetryDiagnosis result;
  result.hypotheses = best.hypotheses;
  result.corrected = best.hypotheses->simulation().model;
  result.unsettled = best.hypotheses->simulation().unsettled;
  explain(result, best.found);
  compare_parameters(result);
  options_.tick(0.8);
  look_at_remainder(result);
  options_.tick(0.9);
  name_events(result);
  decide(result);
  result.telemetry = cleaned_;
  result.isolability = isolability(*result.hypotheses, result.final.noise);
  result.decoys = decoys(*result.hypotheses, result.members, result.final, options_.seed);
  const VectorXd steps =
      result.final.coefficients.head(static_cast<Index>(result.hypotheses->baseline().size()));
  move_parameters(result.hypotheses->baseline(), steps, result.corrected, result.unsettled);
  return result;
}

}  // namespace

TelemetryDiagnosis diagnose_telemetry(const Telemetry& telemetry, const NominalModel& model,
                                      const TelemetryOptions& options) {
  if (telemetry.rows() < 256) throw std::invalid_argument("fewer than 256 rows");
  if (!std::ranges::any_of(kOutputs, [&](Output output) { return telemetry.has(output); }))
    throw std::invalid_argument("no output channel");
  return Diagnosis(telemetry, model, options).run();
}

}  // namespace hemi::diagnosis

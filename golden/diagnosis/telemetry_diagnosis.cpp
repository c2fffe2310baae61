// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/telemetry_diagnosis.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "golden/diagnosis/explain.hpp"
#include "golden/diagnosis/form_error.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Members = std::vector<Member>;

// In units of the score, twice a log likelihood.
constexpr double kStructure = 50.0;  // a free function of an input
constexpr double kStructureInTime = 150.0;
constexpr double kBesideColour = 0.0;  // the same where a walk or 1/f noise would be named
constexpr double kWander = 4.5;        // squares of an output that nobody explains, over those expected
// Colour of the rate that the model does not state. A likelihood of variances scatters by the noise's
// kurtosis: heavy tails of kurtosis 6 make 2.5 of what Gaussian noise does.
constexpr double kColour = 60.0;
// Of an effect's trace: no equation of ours is better, and what it leaves behind is no noise.
constexpr double kEquations = 0.01;
constexpr Index kFineNodes = 32;
constexpr double kRecalibrate_p = 1e-6;
constexpr double kRecalibrateTogether_p = 1e-12;
constexpr double kMovedAlone = 4.5;
constexpr double kRemaining = 0.35;  // of the squares beyond noise
constexpr double kJump = 6.0;        // deviations
constexpr Index kLeastJumps = 3;
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
  double remaining_share(const TelemetryDiagnosis& result, Output output) const;
  void look_at_remainder(TelemetryDiagnosis& result);
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

// Squares beyond what noise is expected to leave, after the effects, over those before them.
double Diagnosis::remaining_share(const TelemetryDiagnosis& result, Output output) const {
  const std::size_t c = place(output);
  const auto& h = *result.hypotheses;
  const Noise& expected = h.expected();
  const auto beyond = [&](const Reduced& residual) {
    const VectorXd e =
        whiten(residual[c], space_.blocks(output), coloured_noise(expected[c], space_.block_count()));
    return e.squaredNorm() - static_cast<double>(e.size());
  };
  const auto free = result.hypotheses->fit({}, expected);
  const auto with = result.hypotheses->fit(result.members, expected);
  const double before = beyond(free.residual);
  return before <= 0.0 ? 0.0 : std::max(beyond(with.residual), 0.0) / before;
}

// What moves beyond the noise that is expected, and with no input.
Remainder along_no_input(Output output, double evidence) {
  Remainder remainder;
  remainder.output = output;
  remainder.evidence = evidence;
  remainder.share = 1.0;
  return remainder;
}

const Remainder* best_of(const std::vector<Remainder>& list, Output output) {
  const Remainder* best = nullptr;
  for (const auto& each : list)
    if (each.output == output && (!best || each.evidence > best->evidence)) best = &each;
  return best;
}

// Squares of the innovations that no noise makes: of the rows that stand kJump deviations off, if there are
// several. What comes and goes looks like a walk to the fit of the noise; its steps do not.
double jumps(const TelemetryDiagnosis& result, Output output) {
  const std::size_t c = place(output);
  const RowSpace& space = result.hypotheses->space();
  const VectorXd white = whiten(result.final.residual[c], space.blocks(output),
                                coloured_noise(result.final.noise[c], space.block_count()));
  const auto off = white.array().abs() > kJump;
  return off.count() < kLeastJumps ? 0.0 : off.select(white.array().square(), 0.0).sum();
}

// Deviation over the recording; a walk's about its mean is its end's over sqrt 6.
double drift_of(const Colour& colour, const Simulation& s) {
  const double duration_s = s.telemetry->step_s * static_cast<double>(s.telemetry->rows());
  return colour.walk_over_flicker > 0.0 ? colour.walk * std::sqrt(duration_s / 6.0) : colour.flicker;
}

// Root mean square of what the effects do to an output.
double size_of(const TelemetryDiagnosis& result, Output output) {
  const std::size_t c = place(output);
  VectorXd sum = VectorXd::Zero(result.hypotheses->space().rows(output));
  for (std::size_t m = 0; m < result.members.size(); ++m) {
    const MatrixXd& own = result.hypotheses->columns(result.members[m])[c];
    sum += own * result.final.coefficients.segment(result.final.first[m], own.cols());
  }
  return std::sqrt(sum.squaredNorm() / static_cast<double>(std::max<Index>(sum.size(), 1)));
}

void Diagnosis::look_at_remainder(TelemetryDiagnosis& result) {
  const auto functions = remainders(*result.hypotheses, result.members, kBesideColour);
  for (const Output output : kOutputs) {
    const Remainder* best = best_of(functions, output);
    if (best && best->evidence > kStructure) result.remainders.push_back(*best);
  }
  std::vector<std::size_t> all(result.members.size());
  std::iota(all.begin(), all.end(), 0U);
  const Reduced forms = form_directions(*result.hypotheses, result.members, result.final, all);
  const Colour colour = colour_of(*result.hypotheses, result.members, forms, Output::rate);
  if (colour.evidence > kColour && !colour.is_line() &&
      drift_of(colour, result.hypotheses->simulation()) > kEquations * size_of(result, Output::rate)) {
    // A walk takes what a function of an input would: that function must not be worth its price, unless time
    // is the better input, which is what a walk looks like.
    const Remainder* function = best_of(functions, Output::rate);
    if (!function || function->variable == "time_s")
      result.colours.push_back(colour);
    else if (function->evidence <= kStructure)
      result.remainders.push_back(*function);
  }
  if (colour.evidence > kColour && colour.is_line())
    result.remainders.push_back(along_no_input(Output::rate, colour.evidence));
  for (auto& remainder : result.remainders) remainder.share = remaining_share(result, remainder.output);
  for (const Output output : {Output::frequency, Output::drive, Output::quadrature}) {
    const Index rows = space_.rows(output);
    if (rows < 64) continue;
    const std::size_t c = place(output);
    const double expected =
        coloured_noise(result.hypotheses->expected()[c], space_.block_count()).total_variance();
    // What the model's own numbers could still take is no wander: whitened, a constant weighs next to
    // nothing.
    const MatrixXd own = orthonormal(result.hypotheses->design(result.members)[c]);
    const VectorXd residual = result.final.residual[c];
    const VectorXd wander = residual - own * (own.transpose() * residual);
    const double ratio = wander.squaredNorm() / (static_cast<double>(rows) * expected);
    const double evidence =
        ratio > kWander ? static_cast<double>(rows) * (ratio - 1.0) : jumps(result, output);
    if (evidence == 0.0) continue;
    result.remainders.push_back(along_no_input(output, evidence));
    result.remainders.back().share = remaining_share(result, output);
  }
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

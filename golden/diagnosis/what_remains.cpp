// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/what_remains.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "golden/diagnosis/form_error.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// In units of the score, twice a log likelihood.
constexpr double kStructure = 50.0;    // a free function of an input
constexpr double kBesideColour = 0.0;  // the same where a walk or 1/f noise would be named
constexpr double kWander = 4.5;        // squares of an output that nobody explains, over those expected
// Colour of the rate that the model does not state. A likelihood of variances scatters by the noise's
// kurtosis: heavy tails of kurtosis 6 make 2.5 of what Gaussian noise does.
constexpr double kColour = 60.0;
// Of an effect's trace: no equation of ours is better, and what it leaves behind is no noise.
constexpr double kEquations = 0.01;
constexpr double kJump = 6.0;  // deviations
constexpr Index kLeastJumps = 3;

// Shares of all remainders: squares beyond what noise is expected to leave, after the effects, over those
// before them.
void state_shares(TelemetryDiagnosis& result) {
  if (result.remainders.empty()) return;
  const RowSpace& space = result.hypotheses->space();
  const Noise& expected = result.hypotheses->expected();
  const auto free = result.hypotheses->fit({}, expected);
  const auto with = result.hypotheses->fit(result.members, expected);
  for (auto& remainder : result.remainders) {
    const std::size_t c = place(remainder.output);
    const auto noise = coloured_noise(expected[c], space.block_count());
    const auto beyond = [&](const Reduced& residual) {
      const VectorXd e = whiten(residual[c], space.blocks(remainder.output), noise);
      return e.squaredNorm() - static_cast<double>(e.size());
    };
    const double before = beyond(free.residual);
    remainder.share = before <= 0.0 ? 0.0 : std::max(beyond(with.residual), 0.0) / before;
  }
}

// What moves beyond the noise that is expected, and with no input.
Remainder along_no_input(Output output, double evidence) {
  Remainder remainder;
  remainder.output = output;
  remainder.evidence = evidence;
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

void look_at_functions_and_colour(TelemetryDiagnosis& result) {
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
}

void look_at_wander(TelemetryDiagnosis& result) {
  const RowSpace& space = result.hypotheses->space();
  for (const Output output : {Output::frequency, Output::drive, Output::quadrature}) {
    const Index rows = space.rows(output);
    if (rows < 64) continue;
    const std::size_t c = place(output);
    const double expected =
        coloured_noise(result.hypotheses->expected()[c], space.block_count()).total_variance();
    // What the model's own numbers could still take is no wander: whitened, a constant weighs next to
    // nothing.
    const MatrixXd own = orthonormal(result.hypotheses->design(result.members)[c]);
    const VectorXd residual = result.final.residual[c];
    const VectorXd wander = residual - own * (own.transpose() * residual);
    const double ratio = wander.squaredNorm() / (static_cast<double>(rows) * expected);
    const double evidence =
        ratio > kWander ? static_cast<double>(rows) * (ratio - 1.0) : jumps(result, output);
    if (evidence > 0.0) result.remainders.push_back(along_no_input(output, evidence));
  }
}

}  // namespace

void look_at_remainder(TelemetryDiagnosis& result) {
  look_at_functions_and_colour(result);
  look_at_wander(result);
  state_shares(result);
}

}  // namespace hemi::diagnosis

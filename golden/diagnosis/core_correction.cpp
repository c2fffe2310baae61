// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/core_correction.hpp"

#include <algorithm>
#include <cmath>

#include "golden/diagnosis/ridge_projection.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr Index kMostRows = 4000;  // slow functions: one row in seven seconds of eight hours
constexpr Index kThermometerTerms = 6;
constexpr std::size_t kMostEffects = 4;  // of which all subsets are tried
// Below these the spans are nothing that a chamber has done.
constexpr double kLeastSpan_hz = 0.01, kLeastSlope_hz_per_s = 1e-6, kLeastSpan_degc = 0.05;

double variation(const ArrayXd& y) {
  return (y - y.mean()).square().sum();
}

// One in some of the powered rows, for speed.
std::vector<Index> chosen_rows(const Telemetry& t) {
  const Index stride = std::max<Index>(1, t.rows() / kMostRows);
  std::vector<Index> rows;
  for (Index i = 0; i < t.rows(); i += stride)
    if (t.powered[i]) rows.push_back(i);
  return rows;
}

// The recording's temperatures and nothing else; outputs as the corrected model has them, since effects may
// follow them.
Telemetry at_rest(const TelemetryDiagnosis& result, double set_point) {
  Telemetry t = *result.telemetry;
  t.amplitude.setConstant(set_point);
  for (auto* input : {&t.supply_v, &t.accel_g}) input->setConstant(median(*input));
  for (auto* input : {&t.rate_in_dph, &t.trim_v}) input->setZero();
  const Simulation s = simulate(t, result.corrected, result.unsettled);
  const ArrayXd amplitude = t.amplitude;
  for (const Output output : kOutputs)
    if (t.has(output)) t.outputs[place(output)] = s.nominal[output];
  if (t.has(Output::drive)) t.outputs[place(Output::drive)] = amplitude * s.model.drive_v.at(s.smooth_degc);
  if (t.has(Output::quadrature))
    t.outputs[place(Output::quadrature)] = amplitude * s.model.quadrature_v.at(s.smooth_degc);
  return t;
}

class Core {
 public:
  Core(const TelemetryDiagnosis& result, const NominalModel& given, const CoreOperation& operation)
      : result_(result),
        given_(given),
        telemetry_(at_rest(result, operation.amplitude)),
        s_(simulate(telemetry_, result.corrected, result.unsettled)),
        late_rows_(operation.derivative_late_s / telemetry_.step_s),
        rows_(chosen_rows(telemetry_)),
        f_(s_.smooth_f) {
    for (const auto& entry : result.named) {
      traces_.push_back(effect_along(result, entry, s_));
      if (traces_.back()[Output::frequency].size() > 0) f_ += traces_.back()[Output::frequency].array();
    }
    const ArrayXd f = f_(rows_), df = slope_late(f_)(rows_), degc = s_.smooth_degc(rows_);
    centre_ = 0.5 * (f.minCoeff() + f.maxCoeff());
    half_ = std::max(0.5 * span(f), kLeastSpan_hz);
    fastest_ = std::max(df.abs().maxCoeff(), kLeastSlope_hz_per_s);
    middle_degc_ = 0.5 * (degc.minCoeff() + degc.maxCoeff());
    half_degc_ = std::max(0.5 * span(degc), kLeastSpan_degc);
    const auto terms = bias_terms((f - centre_) / half_, df / fastest_);
    rate_basis_.resize(f.size(), kBiasTermCount);
    for (std::size_t i = 0; i < kBiasTermCount; ++i) rate_basis_.col(static_cast<Index>(i)) = terms[i];
    temperature_basis_.resize(f.size(), kThermometerTerms);
    for (Index i = 0; i < kThermometerTerms; ++i)
      temperature_basis_.col(i) = ((degc - middle_degc_) / half_degc_).pow(static_cast<double>(i));
  }

  CoreCorrection correction() const {
    CoreCorrection core;
    core.model = result_.corrected;
    core.low_degc = middle_degc_ - half_degc_;
    core.high_degc = middle_degc_ + half_degc_;
    core.driven_dph = VectorXd::Zero(f_.size());
    ArrayXd frequency = ArrayXd::Zero(f_.size());
    const std::size_t taken = correct_rate(core.model);
    for (std::size_t i = 0; i < traces_.size(); ++i) {
      const VectorXd& recorded = result_.named[i].trace[Output::rate];
      if (recorded.size() > 0) core.driven_dph += recorded;
      if (traces_[i][Output::rate].size() > 0) core.driven_dph -= traces_[i][Output::rate];
      CoreShare share = share_of(result_.named[i].effect, traces_[i]);
      share.traced = std::ranges::any_of(result_.named[i].trace.outputs,
                                         [](const VectorXd& each) { return each.size() > 0; });
      if ((taken >> i & 1U) == 0) share.rate = 0.0;
      if (share.temperature >= kLeastCoreShare) {
        frequency += traces_[i][Output::frequency].array();
        core.frequency_changed = true;
      }
      core.shares.push_back(share);
    }
    if (core.frequency_changed)
      add_frequency(project(temperature_basis_, frequency(rows_)).coefficients, core.model.frequency_hz);
    return core;
  }

 private:
  // Which effects go in, a bit each: those with which the whole change of the rate, parameters and effects,
  // is predicted best where it was left out. What the bias took from an effect comes back with it alone.
  std::size_t correct_rate(NominalModel& model) const {
    const auto now = bias_dph(result_.corrected, s_.smooth_f, slope_in_time(s_.smooth_f, telemetry_.step_s));
    const ArrayXd moved = now - bias_dph(given_, s_.smooth_f, slope_late(s_.smooth_f));
    std::vector<VectorXd> left;
    VectorXd whole = moved(rows_);
    for (const auto& trace : traces_) whole += left.emplace_back(left_of(trace)(rows_));
    // Nothing but the given bias is the least that can be done.
    double least = whole.squaredNorm();
    std::size_t best = 0;
    model.bias_dph = given_.bias_dph;
    NominalModel corrected = model;
    const std::size_t sets = std::size_t{1} << traces_.size();
    const bool all_sets = traces_.size() <= kMostEffects;
    for (std::size_t set = 0; set < sets; set += all_sets || set > 0 ? 1 : sets - 1) {
      VectorXd part = moved(rows_);
      for (std::size_t i = 0; i < left.size(); ++i)
        if ((set >> i & 1U) != 0) part += left[i];
      const Projection projection = project(rate_basis_, part);
      const double squares = (whole - projection.left_out).squaredNorm();
      if (squares >= least) continue;
      least = squares;
      best = set;
      corrected = model;
      add_rate(projection.coefficients, corrected);
    }
    model = corrected;
    return best;
  }

  ArrayXd slope_late(const ArrayXd& f) const { return late(slope_in_time(f, telemetry_.step_s), late_rows_); }

  // What an effect does to the rate beyond what the core takes off with the frequency that it counts.
  ArrayXd left_of(const Trace& trace) const {
    ArrayXd left = ArrayXd::Zero(f_.size());
    if (trace[Output::rate].size() > 0) left += trace[Output::rate].array();
    if (trace[Output::frequency].size() == 0) return left;
    const ArrayXd moved = s_.smooth_f + trace[Output::frequency].array();
    return left - bias_dph(result_.corrected, moved, slope_late(moved)) +
           bias_dph(result_.corrected, s_.smooth_f, slope_late(s_.smooth_f));
  }

  CoreShare share_of(const std::string& effect, const Trace& trace) const {
    CoreShare share{.effect = effect};
    const auto of = [](const MatrixXd& basis, const VectorXd& y, double whole) {
      return std::clamp(1.0 - (y - project(basis, y).left_out).squaredNorm() / whole, 0.0, 1.0);
    };
    const ArrayXd left = left_of(trace)(rows_);
    double whole = variation(left);
    if (trace[Output::rate].size() > 0)
      whole = std::max(whole, variation(trace[Output::rate].array()(rows_)));
    share.in_rate = whole > 0.0;
    if (share.in_rate) share.rate = of(rate_basis_, left, whole);
    // Where heat moves the frequency, the drive follows as well and the thermometer reads truly.
    share.in_frequency = trace[Output::frequency].size() > 0 && trace[Output::drive].size() == 0;
    if (!share.in_frequency) return share;
    const ArrayXd moved = trace[Output::frequency].array()(rows_);
    share.temperature = of(temperature_basis_, moved, variation(moved));
    return share;
  }

  void add_rate(const VectorXd& c, NominalModel& model) const {
    auto& b = model.bias_dph;
    const auto add = [&](std::initializer_list<std::size_t> terms, int slope_power) {
      VectorXd inner(static_cast<Index>(terms.size()));
      Index k = 0;
      for (const std::size_t term : terms) inner[k++] = c[static_cast<Index>(term)];
      const VectorXd outer = substituted(inner, 1.0 / half_, -centre_ / half_);
      k = 0;
      for (const std::size_t term : terms) b[term] += outer[k++] / std::pow(fastest_, slope_power);
    };
    // Of each power of df, the powers of f, ascending.
    add({0, 1, 2, 3}, 0);
    add({4, 7, 8}, 1);
    add({5, 9}, 2);
    add({6}, 3);
  }

  void add_frequency(const VectorXd& c, Polynomial& polynomial) const {
    const VectorXd outer =
        substituted(c, 1.0 / half_degc_, (polynomial.reference - middle_degc_) / half_degc_);
    polynomial.coefficients.resize(
        std::max(polynomial.coefficients.size(), static_cast<std::size_t>(outer.size())));
    for (Index i = 0; i < outer.size(); ++i) polynomial.coefficients[static_cast<std::size_t>(i)] += outer[i];
  }

  const TelemetryDiagnosis& result_;
  const NominalModel& given_;
  Telemetry telemetry_;
  Simulation s_;
  double late_rows_;
  std::vector<Index> rows_;
  ArrayXd f_;  // as the core counts it, less the bias model's reference
  std::vector<Trace> traces_;
  double centre_ = 0.0, half_ = 1.0, fastest_ = 1.0, middle_degc_ = 0.0, half_degc_ = 1.0;
  MatrixXd rate_basis_, temperature_basis_;
};

}  // namespace

CoreCorrection core_correction(const TelemetryDiagnosis& result, const NominalModel& given,
                               const CoreOperation& operation) {
  return Core(result, given, operation).correction();
}

Trace effect_along(const TelemetryDiagnosis& result, const Explanation& effect, const Simulation& other) {
  const auto here = family_of(result.hypotheses->families(), effect.effect, effect.form);
  const auto families = effect_families(other);
  const auto there = family_of(families, effect.effect, effect.form);
  if (!here || !there) return {};
  const auto member = std::ranges::find(result.members, *here, &Member::family);
  if (member == result.members.end()) return {};
  const auto columns = families[*there].columns(other, member->shape);
  const Index first = result.final.first[static_cast<std::size_t>(member - result.members.begin())];
  return summed(columns, result.final.coefficients.segment(first, static_cast<Index>(columns.size())));
}

VectorXd corrected_rate(const TelemetryDiagnosis& result) {
  VectorXd rate = simulate(*result.telemetry, result.corrected, result.unsettled).nominal[Output::rate];
  for (const auto& entry : result.named)
    if (entry.trace[Output::rate].size() > 0) rate += entry.trace[Output::rate];
  return rate;
}

}  // namespace hemi::diagnosis

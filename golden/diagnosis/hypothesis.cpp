// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/hypothesis.hpp"

#include <Eigen/QR>
#include <cmath>

#include "golden/diagnosis/scaled_normal.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Trace data_trace(const Telemetry& telemetry, const Trace& nominal) {
  Trace trace;
  for (const Output output : kOutputs)
    if (telemetry.has(output)) trace[output] = telemetry[output] - nominal[output];
  return trace;
}

}  // namespace

MatrixXd orthonormal(const MatrixXd& columns) {
  std::vector<Index> kept;
  for (Index j = 0; j < columns.cols(); ++j)
    if (columns.col(j).squaredNorm() > 0.0) kept.push_back(j);
  MatrixXd scaled(columns.rows(), static_cast<Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i)
    scaled.col(static_cast<Index>(i)) = columns.col(kept[i]).normalized();
  Eigen::ColPivHouseholderQR<MatrixXd> qr(scaled);
  qr.setThreshold(1e-9);
  return qr.householderQ() * MatrixXd::Identity(scaled.rows(), qr.rank());
}

Reduced joined(const std::vector<const Reduced*>& parts) {
  Reduced all;
  for (std::size_t c = 0; c < kOutputs.size(); ++c) {
    Index columns = 0;
    for (const auto* part : parts) columns += (*part)[c].cols();
    all[c].resize(parts.empty() ? 0 : (*parts[0])[c].rows(), columns);
    Index at = 0;
    for (const auto* part : parts) {
      all[c].middleCols(at, (*part)[c].cols()) = (*part)[c];
      at += (*part)[c].cols();
    }
  }
  return all;
}

Hypotheses::Hypotheses(const Telemetry& telemetry, const RowSpace& space, Simulation simulation,
                       std::vector<EffectFamily> families)
    : space_(space),
      simulation_(std::move(simulation)),
      families_(std::move(families)),
      baseline_(baseline_columns(simulation_)) {
  std::vector<const Trace*> traces;
  for (const auto& column : baseline_) traces.push_back(&column.trace);
  baseline_rows_ = space_.reduce(traces);
  const Trace difference = data_trace(telemetry, simulation_.nominal);
  data_ = space_.reduce({&difference});
  expected_ = expected_noise(simulation_, space_, data_);
  // What the baseline explains (a lag above all) moves from block to block as well, and is no noise.
  expected_ = expected_noise(simulation_, space_, fit({}, expected_).residual);
}

const Reduced& Hypotheses::columns(const Member& member) {
  const auto found = columns_.find(member);
  if (found != columns_.end()) return found->second;
  check_();
  const auto traces = families_[member.family].columns(simulation_, member.shape);
  std::vector<const Trace*> list;
  for (const auto& trace : traces) list.push_back(&trace);
  return columns_.emplace(member, space_.reduce(list)).first->second;
}

Reduced Hypotheses::design(const std::vector<Member>& members) {
  std::vector<const Reduced*> parts = {&baseline_rows_};
  for (const auto& member : members) parts.push_back(&columns(member));
  return joined(parts);
}

VectorXd Hypotheses::prior_precision(Index columns) const {
  VectorXd precision = VectorXd::Zero(columns);
  for (std::size_t i = 0; i < baseline_.size(); ++i)
    if (baseline_[i].prior_sd > 0.0)
      precision[static_cast<Index>(i)] = 1.0 / std::pow(baseline_[i].prior_sd, 2);
  return precision;
}

MatrixXd Hypotheses::noise_basis(Output output, const std::vector<Member>& members) {
  return orthonormal(design(members)[place(output)]);
}

const NoiseShape& Hypotheses::own_noise(Output output, const std::vector<Member>& members) {
  const std::size_t c = place(output);
  std::vector<Member> acting;
  for (const auto& member : members)
    if (columns(member)[c].squaredNorm() > 0.0) acting.push_back(member);
  const auto key = std::pair(c, acting);
  const auto found = noises_.find(key);
  if (found != noises_.end()) return found->second;
  check_();
  const auto shape =
      fit_noise_shape(noise_basis(output, acting), data_[c].col(0), space_.blocks(output), expected_[c]);
  return noises_.emplace(key, shape).first->second;
}

HypothesisFit Hypotheses::fit(const std::vector<Member>& members) {
  Noise noise = expected_;
  for (const Output output : kOutputs)
    if (space_.rows(output) > 0) noise[place(output)] = own_noise(output, members);
  return fit(members, noise);
}

HypothesisFit Hypotheses::fit(const std::vector<Member>& members, const Noise& noise) {
  check_();
  HypothesisFit result;
  result.noise = noise;
  const Reduced x = design(members);
  auto next = static_cast<Index>(baseline_.size());
  for (const auto& member : members) {
    result.first.push_back(next);
    next += columns(member)[0].cols();
  }
  const MatrixXd white = whiten(space_, noise, x);
  const VectorXd y = whiten(space_, noise, data_);
  const ScaledNormal solver(white, prior_precision(next));
  result.coefficients = solver.solve(white.transpose() * y);
  result.covariance = solver.covariance();
  result.squares = (y - white * result.coefficients).squaredNorm();
  result.minus_two_log_likelihood =
      result.squares + (prior_precision(next).array() * result.coefficients.array().square()).sum();
  for (const Output output : kOutputs) {
    const std::size_t c = place(output);
    result.residual[c] = data_[c];
    if (space_.rows(output) == 0) continue;
    result.residual[c] -= x[c] * result.coefficients;
    double log_determinant = 0.0;
    const MatrixXd none(space_.rows(output), 0);
    whiten(none, space_.blocks(output), coloured_noise(noise[c], space_.block_count()), &log_determinant);
    result.minus_two_log_likelihood += log_determinant;
  }
  return result;
}

}  // namespace hemi::diagnosis
